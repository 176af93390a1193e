# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension
from rosidl_runtime_py import get_interface_packages

from ros2interface import kinds


class PackagesVerb(VerbExtension):
    """Output a list of packages that provide interfaces."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        kinds.add_arguments(parser, 'Only list packages that generate {}s')

    def main(self, *, args: argparse.Namespace) -> None:
        chosen = kinds.chosen(args)
        found = chosen[0].interfaces() if chosen else get_interface_packages()
        for package in sorted(found):
            print(package)
