# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.verb import VerbExtension
from rosbag2_py.storages import STORAGES


class ListVerb(VerbExtension):
    """Print information about available plugins to the screen."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        parser.add_argument(
            'plugin_type',
            choices=('storage', 'converter', 'compressor', 'decompressor'),
            help='Which plugins; here there are some for storage alone.',
        )
        arguments.add_flags(parser, {'-v --verbose': 'Say as well what each is.'})

    def main(self, *, args: argparse.Namespace) -> None:
        if args.verbose:
            print(f'available {args.plugin_type} plugins are:')
        for storage in STORAGES.values() if args.plugin_type == 'storage' else ():
            if args.verbose:
                print(f'name: {storage.id}')
                print(f'\tfiles *{storage.suffix}, presets {", ".join(storage.presets)}')
            else:
                print(storage.id)
