# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How messages are shown: the options of `echo`, and what they do."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import arguments
from rosidl_runtime_py import message_to_csv, message_to_yaml
import yaml

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
        help='The length to truncate arrays, bytes, and string to '
        f'(default: {_TRUNCATE_LENGTH} in a message)',
    )
    arguments.add_flags(
        parser,
        {
            '--no-arr': "Don't print array fields of messages",
            '--no-str': "Don't print string fields of messages",
            '--flow-style': 'Print collections in the flow style, on one line',
        },
    )


def show(value: Any, args: argparse.Namespace, info: dict[str, Any] | None = None) -> None:
    """Print a message, a field of one, or raw bytes, as the options ask for it.

    :param info: what is known of the message; printed with it where it is given.
    """
    if not hasattr(value, 'get_fields_and_field_types'):
        if info is not None:
            print(f'---Got new message, message info:---\n{info}\n---Message data:---')
        # As upstream, in full: a script that asks for a field goes on with what it holds.
        length = None if args.full_length else args.truncate_length
        print(_plain(value, length), end='\n' if args.csv else '\n---\n')
    elif args.csv:
        told = [] if info is None else map(str, info.values())
        print(','.join([*told, message_to_csv(value, **_options(args))]))
    else:
        if info is not None:
            print(yaml.dump(info), end='---\n')
        print(as_yaml(value, args), end='---\n')


def as_yaml(msg: Any, args: argparse.Namespace) -> str:
    return message_to_yaml(msg, flow_style=args.flow_style, **_options(args))


def _options(args: argparse.Namespace) -> dict[str, Any]:
    return {'truncate_length': _length(args), 'no_arr': args.no_arr, 'no_str': args.no_str}


def _length(args: argparse.Namespace) -> int | None:
    if args.full_length:
        return None
    return _TRUNCATE_LENGTH if args.truncate_length is None else args.truncate_length


def _plain(value: Any, length: int | None) -> Any:
    """Cut a field that is no message, as its array or string would be cut inside one."""
    if isinstance(value, bytes) or not hasattr(value, '__len__'):
        return value
    if length is None or len(value) <= length:
        return value
    cut = value[:length]
    return f'{cut}...' if isinstance(value, str) else [*cut, '...']
