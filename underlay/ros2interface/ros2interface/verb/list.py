# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.verb import VerbExtension
from rosidl_runtime_py import (
    get_action_interfaces,
    get_message_interfaces,
    get_service_interfaces,
)


class ListVerb(VerbExtension):
    """List all interface types available."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_flags(
            parser,
            {
                '-m --only-msgs': 'Print out only the message types',
                '-s --only-srvs': 'Print out only the service types',
                '-a --only-actions': 'Print out only the action types',
            },
        )

    def main(self, *, args: argparse.Namespace) -> None:
        sections = (
            ('Messages', args.only_msgs, get_message_interfaces),
            ('Services', args.only_srvs, get_service_interfaces),
            ('Actions', args.only_actions, get_action_interfaces),
        )
        everything = not any(chosen for _, chosen, _ in sections)
        for title, chosen, interfaces in sections:
            if chosen or everything:
                print(f'{title}:')
                for package, names in sorted(interfaces().items()):
                    for name in names:
                        print(f'    {package}/{name}')
