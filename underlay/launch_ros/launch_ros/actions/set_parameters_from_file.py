# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set parameters of every node from a file."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType

from ..parameter_descriptions import ParameterFile


@expose_action('set_parameters_from_file')
class SetParametersFromFile(Action):
    """Gives a parameter file to the nodes that follow in its scope; their own settings win."""

    _attributes = {'filename': 'filename'}

    def __init__(self, filename: ParameterFile | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        is_file = isinstance(filename, ParameterFile)
        self.__file: ParameterFile = filename if is_file else ParameterFile(filename)  # type: ignore[assignment, arg-type]

    def execute(self, context: LaunchContext) -> None:
        path = self.__file.evaluate(context)
        if not path.is_file():
            raise FileNotFoundError(f"the parameter file '{path}' does not exist")
        known = context.launch_configurations.get('global_params', [])
        context.launch_configurations['global_params'] = [*known, str(path)]
