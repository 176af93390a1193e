# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue
from ros2cli.node.direct import command_node, CommandNode
from ros2cli.verb import VerbExtension
import yaml

from ros2param import api, params


class DumpVerb(VerbExtension):
    """Show all of the parameters of a node in a YAML file format."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)

    def main(self, *, args: argparse.Namespace) -> None:
        node_name = params.find_node(args)
        with command_node(args) as node:
            names = api.list_names(node=node, node_name=node_name, may_take_long=True)
            found = _values(node, node_name, names)
        tree: dict[str, Any] = {}
        for name, value in found.items():
            if value.type != ParameterType.PARAMETER_NOT_SET:
                insert(tree, name, api.get_value(parameter_value=value))
        print(yaml.dump({node_name: {'ros__parameters': tree}}, default_flow_style=False))


def _values(node: CommandNode, node_name: str, names: list[str]) -> dict[str, ParameterValue]:
    """Return what the parameters are set to; a node of Python tells nothing of one that is not."""
    values = api.call_get_parameters(node=node, node_name=node_name, parameter_names=names).values
    if len(values) == len(names):
        return dict(zip(names, values, strict=True))
    # It answers with nothing as well where only one of them is not set.
    found = {}
    for name in names:
        answer = api.call_get_parameters(node=node, node_name=node_name, parameter_names=[name])
        if answer.values:
            found[name] = answer.values[0]
    return found


def insert(tree: dict[str, Any], name: str, value: Any) -> None:
    """Put a value in nested dictionaries, one a part of the dotted name."""
    first, _, rest = name.partition('.')
    if rest and isinstance(tree.setdefault(first, {}), dict):
        insert(tree[first], rest, value)
    else:
        # A parameter `a` next to `a.b` cannot be nested: the dotted name says the same.
        tree[name] = value
