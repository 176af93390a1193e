# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension

from ros2interface import kinds


class ListVerb(VerbExtension):
    """List all interface types available."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        kinds.add_arguments(parser, 'Print out only the {} types')

    def main(self, *, args: argparse.Namespace) -> None:
        for kind in kinds.chosen(args) or kinds.KINDS:
            print(f'{kind.noun.capitalize()}s:')
            for package, names in sorted(kind.interfaces().items()):
                for name in sorted(names):
                    print(f'    {package}/{name}')
