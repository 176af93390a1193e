# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters as rclpy has them, from dictionaries and files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TYPE_CHECKING
import warnings

from launch.launch_context import LaunchContext
import yaml

from .evaluate_parameters import evaluate_parameter_dict
from .normalize_parameters import normalize_parameter_dict

if TYPE_CHECKING:
    from rclpy.parameter import Parameter

_MARK = 'ros__parameters'


def to_parameters_list(
    context: LaunchContext, node_name: str, namespace: str | None, evaluated_parameters: Any
) -> list[Parameter]:
    """Return the parameters of a node, in their order.

    :param evaluated_parameters: what evaluate_parameters() returns.
    :raises RuntimeError: something in it is neither a file, a dictionary nor a parameter.
    """
    from rclpy.parameter import Parameter

    full_name = '/'.join(filter(None, ((namespace or '').strip('/'), node_name.lstrip('/'))))
    found = []
    for item in evaluated_parameters:
        if isinstance(item, Path):
            of_node = _of_node(yaml.safe_load(item.read_text(encoding='utf-8')) or {}, full_name)
            values = evaluate_parameter_dict(context, normalize_parameter_dict(of_node))
        elif isinstance(item, Mapping):
            values = dict(item)
        else:
            raise RuntimeError(f'invalid evaluated parameters {item!r}')
        found += [Parameter(name, value=value) for name, value in values.items()]
    return found


def _of_node(content: Mapping[str, Any], full_name: str) -> Mapping[str, Any]:
    """Return what a file says for a node: for all nodes, then for itself.

    A file that names no node is for any.
    """
    by_node = dict(_sections(content, ''))
    if not by_node:
        return content
    if not full_name:
        warnings.warn(
            'node name not provided to launch; parameter files will not apply', stacklevel=2
        )
    return {**by_node.get('**', {}), **by_node.get(full_name, {})}


def _sections(content: Mapping[str, Any], name: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Return the parameters of each node in a file by its full name, without the first '/'."""
    for key, value in content.items():
        if key == _MARK:
            yield name, value or {}
        elif isinstance(value, Mapping):
            part = str(key).strip('/')
            yield from _sections(value, f'{name}/{part}' if name else part)
