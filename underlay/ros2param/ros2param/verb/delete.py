# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from rcl_interfaces.msg import ParameterType, ParameterValue
from ros2cli.verb import VerbExtension

from ros2param import params
from ros2param.api import print_result


class DeleteVerb(VerbExtension):
    """Delete parameter."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_name', help='Name of the parameter')

    def main(self, *, args: argparse.Namespace) -> None:
        unset = ParameterValue(type=ParameterType.PARAMETER_NOT_SET)
        result = params.set_one(args, unset)
        print_result(result, 'Deleted parameter successfully', 'Deleting parameter failed')
