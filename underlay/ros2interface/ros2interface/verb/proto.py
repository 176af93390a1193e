# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import completion
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension
from rosidl_runtime_py import message_to_yaml
from rosidl_runtime_py.utilities import get_interface


class ProtoVerb(VerbExtension):
    """Output an interface prototype."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        completion.any_interface(
            parser.add_argument(
                'type', help='Show an interface definition (e.g. "std_msgs/msg/String")'
            )
        )
        parser.add_argument(
            '--no-quotes', action='store_true', help='if true output has no outer quotes.'
        )

    def main(self, *, args: argparse.Namespace) -> None:
        text = message_to_yaml(_message(args.type)())
        print(text if args.no_quotes else f'"{text}"')


def _message(name: str) -> Any:
    """Return the message that a person fills in: a request of a service, a goal of an action."""
    if len(name.split('/')) != 3:
        raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    try:
        interface = get_interface(name)
    except (ValueError, ImportError, AttributeError):
        raise CommandError(
            f"Unknown interface '{name}'; `ros2 interface list` shows them all"
        ) from None
    for part in ('Request', 'Goal'):
        interface = getattr(interface, part, interface)
    return interface
