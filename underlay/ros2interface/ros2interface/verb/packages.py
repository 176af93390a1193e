# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension
from rosidl_runtime_py import (
    get_action_interfaces,
    get_interface_packages,
    get_message_interfaces,
    get_service_interfaces,
)


class PackagesVerb(VerbExtension):
    """Output a list of packages that provide interfaces."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        group = parser.add_mutually_exclusive_group()
        for kind, text, interfaces in (
            ('msgs', 'messages', get_message_interfaces),
            ('srvs', 'services', get_service_interfaces),
            ('actions', 'actions', get_action_interfaces),
        ):
            group.add_argument(
                f'-{kind[0]}',
                f'--only-{kind}',
                dest='interfaces',
                action='store_const',
                const=interfaces,
                default=get_interface_packages,
                help=f'Only list packages that generate {text}',
            )

    def main(self, *, args: argparse.Namespace) -> None:
        for package in sorted(args.interfaces()):
            print(package)
