# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension

from ros2param import params
from ros2param.api import print_result


class SetVerb(VerbExtension):
    """Set parameter."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_name', help='Name of the parameter')
        parser.add_argument('value', help='Value of the parameter')

    def main(self, *, args: argparse.Namespace) -> None:
        result = params.set_one(args, params.from_text(args.value))
        print_result(result, 'Set parameter successful', 'Setting parameter failed')
