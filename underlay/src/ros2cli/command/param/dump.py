# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Show all of the parameters of a node in a YAML file format."""

from __future__ import annotations

import argparse
from typing import Any

from rcl_interfaces.msg import ParameterType
import yaml

from ros2cli import params
from ros2cli.node import command_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    params.add_arguments(parser)


def main(args: argparse.Namespace) -> None:
    node_name = params.find_node(args)
    with command_node(args) as node:
        names = params.names_of(node, node_name)
        values = params.get(node, node_name, names) if names else []
    tree: dict[str, Any] = {}
    for name, value in zip(names, values, strict=True):
        if value.type != ParameterType.PARAMETER_NOT_SET:
            insert(tree, name, params.to_python(value))
    print(yaml.dump({node_name: {'ros__parameters': tree}}, default_flow_style=False))


def insert(tree: dict[str, Any], name: str, value: Any) -> None:
    """Put a value in nested dictionaries, one a part of the dotted name."""
    first, _, rest = name.partition('.')
    if rest and isinstance(tree.setdefault(first, {}), dict):
        insert(tree[first], rest, value)
    else:
        # A parameter `a` beside `a.b` cannot be nested: the dotted name says the same.
        tree[name] = value
