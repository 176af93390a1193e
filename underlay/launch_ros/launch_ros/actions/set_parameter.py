# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set a parameter of every node."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType

from ..utilities import evaluate_parameter_dict, normalize_parameter_dict


@expose_action('set_parameter')
class SetParameter(Action):
    """Sets a parameter of the nodes that follow in its scope; their own settings win."""

    _attributes = {'name': 'name', 'value': 'value'}

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        name = tuple(name) if isinstance(name, list) else name
        ((self.name, self.value),) = normalize_parameter_dict({name: value}).items()

    def execute(self, context: LaunchContext) -> None:
        values = evaluate_parameter_dict(context, {self.name: self.value})
        # A new list: an enclosing scope keeps its own.
        known = context.launch_configurations.get('global_params', [])
        context.launch_configurations['global_params'] = [*known, *values.items()]
