# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import Parameter
from ros2cli import arguments
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
import yaml

from ros2param import params

_WILDCARD = '/**'


class LoadVerb(VerbExtension):
    """Load parameter file for a node."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        params.add_arguments(parser)
        parser.add_argument('parameter_file', help='Parameter file')
        arguments.add_flags(
            parser,
            {'--no-use-wildcard': "Do not load parameters in the '/**' namespace into the node"},
        )

    def main(self, *, args: argparse.Namespace) -> int:
        node_name = params.find_node(args)
        parameters = read(args.parameter_file, node_name, use_wildcard=not args.no_use_wildcard)
        if not parameters:
            raise CommandError(
                f"'{args.parameter_file}' has no parameters for {node_name}: its top level names "
                f'the '
                "node (or '/**'), and below that stands 'ros__parameters'"
            )
        with command_node(args) as node:
            results = params.set_values(node, node_name, parameters)
        failed = 0
        for parameter, result in zip(parameters, results, strict=True):
            reason = f': {result.reason}' if result.reason else ''
            outcome = 'successful' if result.successful else 'failed'
            print(f'Set parameter {parameter.name} {outcome}{reason}')
            failed += not result.successful
        return 1 if failed else 0


def read(file: str, node_name: str, *, use_wildcard: bool) -> list[Parameter]:
    """Read the parameters of a node from a file; what names the node overrides the wildcard.

    :raises CommandError: there is no such file, or it is no parameter file.
    """
    try:
        content = yaml.safe_load(Path(file).read_text(encoding='utf-8'))
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, 'strerror', None) or 'it is no UTF-8 text'
        raise CommandError(f"'{file}' is no file that can be read: {reason}") from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise CommandError(f"'{file}' is no YAML: {' '.join(str(error).split())}") from None
    if not isinstance(content, dict):
        raise CommandError(f"'{file}' is no parameter file: its top level must name nodes")
    found: dict[str, Any] = {}
    keys = [_WILDCARD] if use_wildcard else []
    for key in (*keys, node_name, node_name.lstrip('/')):
        if key in content:
            found |= _flattened(_parameters_of(content[key], file, key))
    return [
        Parameter(name=name, value=params.from_file(name, value)) for name, value in found.items()
    ]


def _parameters_of(value: Any, file: str, key: str) -> dict[Any, Any]:
    below = value.get('ros__parameters') if isinstance(value, dict) else None
    if not isinstance(below, dict):
        raise CommandError(
            f"'{file}' is no parameter file: '{key}' needs 'ros__parameters' with names and values"
        )
    return below


def _flattened(tree: dict[Any, Any], prefix: str = '') -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in tree.items():
        if isinstance(value, dict):
            found |= _flattened(value, f'{prefix}{name}.')
        else:
            found[f'{prefix}{name}'] = value
    return found
