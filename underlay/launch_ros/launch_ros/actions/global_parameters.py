# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of SetParameter and SetParametersFromFile, as a node gets them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from launch.launch_context import LaunchContext
from launch.logging import get_logger
import yaml

from ..utilities.normalize_parameters import as_yaml


def global_parameter_arguments(context: LaunchContext) -> list[tuple[str, bool]]:
    """Return what follows ``-p``, or ``--params-file`` where the second item is True.

    :raises FileNotFoundError: there is no such file.
    :raises ValueError: a text has a form that nodes do not start with.
    """
    arguments = []
    for item in context.launch_configurations.get('global_params', ()):
        if isinstance(item, tuple):
            name, value = item
            arguments.append((f'{name}:={_text(name, value)}', False))
            continue
        path = Path(item).absolute()
        if not path.is_file():
            raise FileNotFoundError(
                f"the parameter file '{path}' of SetParametersFromFile is not a file"
            )
        arguments.append((str(path), True))
    return arguments


def _text(name: str, value: Any) -> str:
    if isinstance(value, str) and value:
        # As upstream: the node reads it as YAML, so that '1' is a number to it.
        _check(name, value)
        return value
    if isinstance(value, tuple):
        get_logger('launch_ros.actions.node').warning(
            f"SetParameter '{name}' has a list, which a full ROS 2 Jazzy passes on as text: use "
            'ParameterValue(list)'
        )
    return as_yaml(value)


def _check(name: str, text: str) -> None:
    try:
        is_value = not isinstance(yaml.safe_load(text), dict)
    except yaml.YAMLError:
        is_value = False
    if not is_value:
        raise ValueError(
            f"SetParameter '{name}' has {text!r}, which is no value to YAML, as which nodes read "
            'it: put quotes into the text'
        )
