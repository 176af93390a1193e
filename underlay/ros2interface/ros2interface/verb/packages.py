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
        for letter, kind, text in (
            ('m', 'msgs', 'messages'),
            ('s', 'srvs', 'services'),
            ('a', 'actions', 'actions'),
        ):
            group.add_argument(
                f'-{letter}',
                f'--only-{kind}',
                action='store_true',
                help=f'Only list packages that generate {text}',
            )

    def main(self, *, args: argparse.Namespace) -> None:
        if args.only_msgs:
            found = list(get_message_interfaces())
        elif args.only_srvs:
            found = list(get_service_interfaces())
        elif args.only_actions:
            found = list(get_action_interfaces())
        else:
            found = list(get_interface_packages())
        for package in sorted(found):
            print(package)
