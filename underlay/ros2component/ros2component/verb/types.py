# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2_diagnosis import packages
from ros2cli import arguments
from ros2cli.verb import VerbExtension

from ros2component import api


class TypesVerb(VerbExtension):
    """Output a list of components registered in the ament index."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_package(
            parser, nargs='?', help='Package name to look for registered components in'
        )

    def main(self, *, args: argparse.Namespace) -> None:
        if args.package_name is not None:
            packages.prefix_of(args.package_name)
            for name in api.get_package_component_types(package_name=args.package_name):
                print(name)
            return
        for package, names in api.get_registered_component_types():
            print(package)
            for name in names:
                print(f'  {name}')
