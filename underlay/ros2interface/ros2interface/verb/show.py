# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys

from ros2cli import arguments, definitions, interfaces
from ros2cli.errors import UsageError
from ros2cli.verb import VerbExtension


class ShowVerb(VerbExtension):
    """Output the interface definition."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        group = parser.add_mutually_exclusive_group()
        arguments.add_flags(
            group,
            {
                '--all-comments': 'Show all comments, including for nested interface definitions',
                '--no-comments': 'Show no comments or whitespace',
            },
        )
        arguments.add_type(
            parser,
            'type',
            '',
            help="Show an interface definition (e.g. 'std_msgs/msg/String'). Passing '-' "
            "reads the argument from stdin (e.g. 'ros2 topic type /chatter | ros2 interface "
            "show -').",
        )

    def main(self, *, args: argparse.Namespace) -> None:
        name = args.type
        if name == '-':
            if sys.stdin.isatty():
                raise UsageError("ros2 interface show: '-' expects the type from a pipe")
            name = sys.stdin.readline().strip()
        interfaces.check_full_name(name)
        _show(name, comments=not args.no_comments, nested_comments=args.all_comments, indent='')


def _show(interface: str, *, comments: bool, nested_comments: bool, indent: str) -> None:
    for line in definitions.lines(interface):
        text = line.text if comments else line.without_comment()
        if comments or (text and not line.is_comment):
            print(f'{indent}{text}' if text else '')
        if line.nested_type:
            _show(
                line.nested_type,
                comments=nested_comments,
                nested_comments=nested_comments,
                indent=indent + '\t',
            )
