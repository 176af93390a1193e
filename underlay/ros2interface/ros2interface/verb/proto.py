# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments, interfaces
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2interface.api import interface_to_yaml


class ProtoVerb(VerbExtension):
    """Output an interface prototype."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_type(
            parser, 'type', '', help='Show an interface definition (e.g. "std_msgs/msg/String")'
        )
        arguments.add_flags(parser, {'--no-quotes': 'if true output has no outer quotes.'})

    def main(self, *, args: argparse.Namespace) -> None:
        interfaces.check_full_name(args.type)
        try:
            text = interface_to_yaml(args.type)
        except (ValueError, ImportError, AttributeError):
            raise CommandError(
                f"Unknown interface '{args.type}'; `ros2 interface list` shows them all"
            ) from None
        print(text if args.no_quotes else f'"{text}"')
