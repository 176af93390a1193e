# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2_diagnosis import packages
from ros2cli import arguments
from ros2cli.verb import VerbExtension


class ExecutablesVerb(VerbExtension):
    """Output a list of package specific executables."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_package(parser, nargs='?', help='The package name (default: all)')
        arguments.add_flags(parser, {'--full-path': 'Show the full path of each executable'})

    def main(self, *, args: argparse.Namespace) -> None:
        chosen = [args.package_name] if args.package_name else sorted(packages.installed())
        for package in chosen:
            for path in packages.executables(package):
                if args.full_path:
                    print(path)
                else:
                    print(f'{package} {path.name}')
