# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ament_index_python import InvalidResourceNameError
from ros2_diagnosis import packages
from ros2cli import arguments
from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension
from rosidl_runtime_py import get_interfaces

from ros2interface import kinds


class PackageVerb(VerbExtension):
    """Output a list of available interface types within one package."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        kinds.add_arguments(parser, 'Print out only the {} types')
        arguments.add_package(parser, help="Name of the ROS package (e.g. 'std_msgs')")

    def main(self, *, args: argparse.Namespace) -> None:
        chosen = [kind.interfaces for kind in kinds.chosen(args)] or [get_interfaces]
        for interfaces in chosen:
            try:
                found = interfaces([args.package_name])
            except (LookupError, InvalidResourceNameError):  # the latter of std_msgs/
                name = args.package_name
                why = packages.why_missing(name)
                raise CommandError(f"Unknown package '{name}': {why}") from None
            for package, names in found.items():
                for name in names:
                    print(f'{package}/{name}')
