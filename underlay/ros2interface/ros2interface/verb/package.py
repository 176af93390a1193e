# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2_diagnosis import packages
from ros2cli import arguments
from ros2cli.verb import VerbExtension
from rosidl_runtime_py import get_interfaces


class PackageVerb(VerbExtension):
    """Output a list of available interface types within one package."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_package(parser, help="Name of the ROS package (e.g. 'std_msgs')")

    def main(self, *, args: argparse.Namespace) -> None:
        packages.prefix_of(args.package_name)
        for package, names in get_interfaces([args.package_name]).items():
            for name in names:
                print(f'{package}/{name}')
