# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A launch description as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from .event_handler import BaseEventHandler
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .utilities import normalize_to_list_of_substitutions

_Tree = tuple[str, list[Any]]


def format_substitutions(substitutions: Any) -> str:
    """Return the substitutions of text, a substitution or a list, as they describe themselves."""
    return ' + '.join(sub.describe() for sub in normalize_to_list_of_substitutions(substitutions))


def _process(action: ExecuteProcess) -> str:
    description = action.process_description
    env = description.env
    return 'ExecuteProcess(cmd=[{}], cwd={}, env={}, shell={})'.format(
        ', '.join(format_substitutions(part) for part in description.cmd),
        None if description.cwd is None else f"'{format_substitutions(description.cwd)}'",
        None
        if env is None
        else {format_substitutions(name): format_substitutions(value) for name, value in env},
        action.shell,
    )


def _handler(handler: BaseEventHandler) -> _Tree:
    text, entities = handler.describe()
    return text, _entities(entities)


def _entities(entities: Iterable[LaunchDescriptionEntity]) -> list[_Tree]:
    return [_entity(entity) for entity in entities]


def _entity(entity: LaunchDescriptionEntity) -> _Tree:
    if isinstance(entity, LogInfo):
        return f'LogInfo({format_substitutions(entity.msg)})', []
    if isinstance(entity, EmitEvent):
        return f"EmitEvent(event='{entity.event.name}')", []
    if isinstance(entity, ExecuteProcess):
        return _process(entity), []
    if isinstance(entity, RegisterEventHandler):
        text = f"RegisterEventHandler('{entity.event_handler}'):"
        return text, [_handler(entity.event_handler)]
    return f"Action('{entity}')", _entities(entity.describe_sub_entities())


def _lines(trees: list[_Tree], before: str = '') -> list[str]:
    lines = []
    for index, (text, branches) in enumerate(trees):
        last = index == len(trees) - 1
        lines.append(before + ('└── ' if last else '├── ') + text)
        lines.extend(_lines(branches, before + ('    ' if last else '│   ')))
    return lines


class LaunchIntrospector:
    """Describes launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the tree of the entities, a line each."""
        return '\n'.join(
            [f'{launch_description}', *_lines(_entities(launch_description.entities))]
        )
