# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from collections.abc import Sequence
import sys
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from ros2_diagnosis import nearest
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension

from ros2param import api, params


class DescribeVerb(VerbExtension):
    """Show descriptive information about declared parameters."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        params.add_parameter(parser, 'parameter_names', nargs='+', help='Names of the parameters')

    def main(self, *, args: argparse.Namespace) -> None:
        node_name = params.find_node(args)
        with command_node(args) as node:
            response = api.call_describe_parameters(
                node=node, node_name=node_name, parameter_names=args.parameter_names
            )
            # rclpy describes none where one of them is missing, and does not say so.
            if len(response.descriptors) < len(args.parameter_names):
                _tell_missing(node, node_name, args.parameter_names)
        for descriptor in response.descriptors:
            _print(descriptor)


def _tell_missing(node: Any, node_name: str, asked: Sequence[str]) -> None:
    names = api.list_names(node=node, node_name=node_name)
    for name in asked:
        if name not in names:
            print(f'Parameter not set: {name}{nearest.hint(name, names)}', file=sys.stderr)


def _print(descriptor: ParameterDescriptor) -> None:
    print(f'Parameter name: {descriptor.name}')
    print(f'  Type: {api.get_parameter_type_string(descriptor.type)}')
    if descriptor.description:
        print(f'  Description: {descriptor.description}')
    print('  Constraints:')
    if descriptor.read_only:
        print('    Read only: true')
    for allowed in [*descriptor.floating_point_range, *descriptor.integer_range][:1]:
        print(f'    Min value: {allowed.from_value}')
        print(f'    Max value: {allowed.to_value}')
        if allowed.step:
            print(f'    Step: {allowed.step}')
    if descriptor.additional_constraints:
        print(f'    Additional constraints: {descriptor.additional_constraints}')
