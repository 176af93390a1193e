# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Remap a name of every node."""

from __future__ import annotations

from typing import Any

from launch.action import Action
from launch.frontend import expose_action
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action('set_remap')
class SetRemap(Action):
    """Remaps a name in the nodes that follow in its scope."""

    _attributes = {'src': 'from', 'dst': 'to'}

    def __init__(
        self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        pair = perform_substitutions(context, self.src), perform_substitutions(context, self.dst)
        known = context.launch_configurations.get('ros_remaps', [])
        context.launch_configurations['ros_remaps'] = [*known, pair]
