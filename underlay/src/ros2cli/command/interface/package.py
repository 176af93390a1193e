# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Output a list of available interface types within one package."""

from __future__ import annotations

import argparse

from rosidl_runtime_py import get_interfaces

from ros2cli import completion, packages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    completion.package(
        parser.add_argument('package_name', help="Name of the ROS package (e.g. 'std_msgs')")
    )


def main(args: argparse.Namespace) -> None:
    packages.prefix_of(args.package_name)
    for package, names in get_interfaces([args.package_name]).items():
        for name in names:
            print(f'{package}/{name}')
