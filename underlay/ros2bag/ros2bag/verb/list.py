# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.verb import VerbExtension
from rosbag2_py import get_registered_compressors
from rosbag2_py.storages import STORAGES


class ListVerb(VerbExtension):
    """Print information about available plugins to the screen."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            'plugin_type',
            choices=('storage', 'converter', 'compressor', 'decompressor'),
            help='Which plugins; here there are none that convert.',
        )
        arguments.add_flags(parser, {'-v --verbose': 'Say as well what each is.'})

    def main(self, *, args: argparse.Namespace) -> None:
        if args.verbose:
            print(f'available {args.plugin_type} plugins are:')
        for name, what in _plugins(args.plugin_type):
            if args.verbose:
                print(f'name: {name}')
                print(f'\t{what}')
            else:
                print(name)


def _plugins(kind: str) -> list[tuple[str, str]]:
    """Return the names of plugins, and what each is."""
    if kind == 'storage':
        return [
            (each.id, f'files *{each.suffix}, presets {", ".join(each.presets)}')
            for each in STORAGES.values()
        ]
    if kind == 'converter':
        return []
    return [(name, 'files and messages') for name in sorted(get_registered_compressors())]
