# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a launch file describes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .actions.declare_launch_argument import DeclareLaunchArgument
from .launch_context import LaunchContext
from .launch_description_entity import LaunchDescriptionEntity
from .logging import get_logger

if TYPE_CHECKING:
    from .actions import IncludeLaunchDescription

_Arguments = list[tuple[DeclareLaunchArgument, list['IncludeLaunchDescription']]]


class LaunchDescription(LaunchDescriptionEntity):
    """A list of entities, visited in order."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities = list(initial_entities or [])
        for entity in self.entities:
            _check_entity(entity)
        self.deprecated_reason = deprecated_reason

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        if self.deprecated:
            path = context.get_locals_as_dict().get('current_launch_file_path')
            what = (
                f'launch file [{path}] is deprecated' if path else 'deprecated launch description'
            )
            get_logger().warning(f'{what}: {self.deprecated_reason}')
        return self.entities

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return self.entities

    def get_launch_arguments(
        self, conditional_inclusion: bool = False
    ) -> list[DeclareLaunchArgument]:
        """Return the declared arguments, each name once."""
        pairs = self.get_launch_arguments_with_include_launch_description_actions(
            conditional_inclusion
        )
        return [argument for argument, _ in pairs]

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False
    ) -> _Arguments:
        """Return the declared arguments, each with the chain of includes that leads to it."""
        found: _Arguments = []
        _collect_arguments(self.entities, found, [], conditional_inclusion)
        unique: _Arguments = []
        for argument, includes in found:
            if argument.name not in {known.name for known, _ in unique}:
                unique.append((argument, includes))
        return unique

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        _check_entity(entity)
        self.entities.append(entity)

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        self.add_entity(action)

    @property
    def deprecated(self) -> bool:
        return self.deprecated_reason is not None


def _check_entity(entity: object) -> None:
    if not isinstance(entity, LaunchDescriptionEntity):
        raise TypeError(
            f'{entity!r} is not a launch action or description: a LaunchDescription holds only '
            'these; is a comma or a bracket in the wrong place?'
        )


def _collect_arguments(
    entities: Iterable[LaunchDescriptionEntity],
    found: _Arguments,
    includes: list[IncludeLaunchDescription],
    conditional: bool,
) -> None:
    from .actions import IncludeLaunchDescription, ResetLaunchConfigurations

    for entity in entities:
        if isinstance(entity, DeclareLaunchArgument):
            entity._conditionally_included = conditional or entity.condition is not None
            found.append((entity, includes))
        if isinstance(entity, ResetLaunchConfigurations):
            # What is declared after it in this scope cannot be given from outside.
            return
        inner = includes
        if isinstance(entity, IncludeLaunchDescription):
            location = entity.launch_description_source.location
            if location in (each.launch_description_source.location for each in includes):
                continue  # the file includes itself
            inner = [*includes, entity]
        _collect_arguments(entity.describe_sub_entities(), found, inner, conditional)
        for _, conditional_entities in entity.describe_conditional_sub_entities():
            _collect_arguments(conditional_entities, found, inner, True)
