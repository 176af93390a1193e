# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Output the prefix path of a package."""

from __future__ import annotations

import argparse

from ros2cli import completion, packages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    completion.package(parser.add_argument('package_name', help='The package name'))
    parser.add_argument(
        '--share',
        action='store_true',
        help='Show share directory of the package, instead of the prefix path',
    )


def main(args: argparse.Namespace) -> None:
    share = packages.share_of(args.package_name)
    print(share if args.share else packages.prefix_of(args.package_name))
