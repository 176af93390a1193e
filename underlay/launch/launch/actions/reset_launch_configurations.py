# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Forget launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..action import Action
from ..frontend import Entity, expose_action, Parser
from ..launch_context import LaunchContext
from ..some_substitutions_type import SomeSubstitutionsType
from ..utilities import normalize_to_list_of_substitutions, perform_substitutions


@expose_action('reset')
class ResetLaunchConfigurations(Action):
    """Forgets every launch configuration but those given, which are evaluated before."""

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__launch_configurations = launch_configurations or {}

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        kwargs = super().parse(entity, parser)[1]
        kept = parser.parse_pairs(entity, 'keep', 'name', 'value')
        kwargs['launch_configurations'] = {tuple(name): value for name, value in kept}
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        kept = {}
        for name, value in self.__launch_configurations.items():
            text = perform_substitutions(context, normalize_to_list_of_substitutions(name))
            kept[text] = perform_substitutions(context, normalize_to_list_of_substitutions(value))
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
