# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How messages are shown: the options of `echo`, and what they do."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import arguments
from rosidl_runtime_py import message_to_csv, message_to_yaml

_TRUNCATE_LENGTH = 128


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_flags(
        parser,
        {
            '--csv': 'Output all recursive fields separated by commas (e.g. for plotting).',
            '--full-length -f': 'Output all elements for arrays, bytes, and string with a length '
            "> '--truncate-length', by default they are truncated after '--truncate-length' "
            "elements with '...'",
        },
    )
    parser.add_argument(
        '--truncate-length',
        '-l',
        type=arguments.nonnegative_int,
        default=_TRUNCATE_LENGTH,
        help='The length to truncate arrays, bytes, and string to (default: %(default)s)',
    )
    arguments.add_flags(
        parser,
        {
            '--no-arr': "Don't print array fields of messages",
            '--no-str': "Don't print string fields of messages",
            '--flow-style': 'Print collections in the flow style, on one line',
        },
    )


def show(value: Any, args: argparse.Namespace) -> None:
    """Print a message, a field of one, or raw bytes, as the options ask for it."""
    length = None if args.full_length else args.truncate_length
    options = {'truncate_length': length, 'no_arr': args.no_arr, 'no_str': args.no_str}
    if not hasattr(value, 'get_fields_and_field_types'):
        print(_plain(value, length), end='\n' if args.csv else '\n---\n')
    elif args.csv:
        print(message_to_csv(value, **options))
    else:
        print(message_to_yaml(value, flow_style=args.flow_style, **options), end='---\n')


def _plain(value: Any, length: int | None) -> Any:
    """Cut a field that is no message, as its array or string would be cut inside one."""
    if isinstance(value, bytes) or not hasattr(value, '__len__'):
        return value
    if length is None or len(value) <= length:
        return value
    cut = value[:length]
    return f'{cut}...' if isinstance(value, str) else [*cut, '...']
