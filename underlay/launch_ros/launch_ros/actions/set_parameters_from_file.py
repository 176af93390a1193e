# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Set parameters of every node from a file."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action('set_parameters_from_file')
class SetParametersFromFile(Action):
    """Gives a parameter file to the nodes that follow in its scope; their own settings win.

    The file is looked for when such a node starts.
    """

    _attributes = {'filename': 'filename'}

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._input_file = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        path = perform_substitutions(context, self._input_file)
        known = context.launch_configurations.get('global_params', [])
        context.launch_configurations['global_params'] = [*known, path]
