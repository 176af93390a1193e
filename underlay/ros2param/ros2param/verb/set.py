# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.errors import CommandError
from ros2cli.verb import VerbExtension

from ros2param import params


class SetVerb(VerbExtension):
    """Set parameter."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_name', help='Name of the parameter')
        parser.add_argument('value', help='Value of the parameter')

    def main(self, *, args: argparse.Namespace) -> None:
        successful, reason = params.set_one(args, params.from_text(args.value))
        if not successful:
            raise CommandError(f'Setting parameter failed{reason}')
        print(f'Set parameter successful{reason}')
