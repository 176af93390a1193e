# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments

from ros2pkg import verb


class PrefixVerb(verb.VerbExtension):
    """Output the prefix path of a package."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_package(parser, help='The package name')
        arguments.add_flags(
            parser, {'--share': 'Show share directory of the package, instead of the prefix path'}
        )

    def main(self, *, args: argparse.Namespace) -> None:
        print((verb.share_of if args.share else verb.prefix_of)(args.package_name))
