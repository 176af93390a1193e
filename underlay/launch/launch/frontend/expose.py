# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The names of actions and substitutions in markup launch files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import difflib
import functools
import importlib
from typing import Any, TYPE_CHECKING, TypeVar
import warnings

import entry_point_index

if TYPE_CHECKING:
    from ..action import Action
    from ..substitution import Substitution
    from .entity import Entity
    from .parser import Parser

action_parse_methods: dict[str, Callable[[Any, Any], Any]] = {}
substitution_parse_methods: dict[str, Callable[[Any], Any]] = {}

_Exposed = TypeVar('_Exposed')


def __expose_impl(
    name: str, methods: dict[str, Callable[..., Any]], kind: str
) -> Callable[[_Exposed], _Exposed]:
    def decorator(exposed: _Exposed) -> _Exposed:
        parse = getattr(exposed, 'parse', None) if isinstance(exposed, type) else exposed
        if not callable(parse):
            raise RuntimeError(
                f'Exposed {kind} parser for {name} is not a callable or a class containing a '
                'parse method'
            )
        if methods.get(name, parse) != parse:
            raise RuntimeError(f"two {kind}s are exposed under the name '{name}'")
        methods[name] = parse
        return exposed

    return decorator


def expose_substitution(name: str) -> Callable[[_Exposed], _Exposed]:
    """Make a class known as ``$(name ...)``."""
    return __expose_impl(name, substitution_parse_methods, 'substitution')


def expose_action(name: str) -> Callable[[_Exposed], _Exposed]:
    """Make a class, or a function that parses, known as the element ``name``."""
    return __expose_impl(name, action_parse_methods, 'action')


@functools.cache
def load_extensions() -> None:
    """Import what belongs to launch, and what distributions register."""
    for name in ('launch.actions', 'launch.substitutions'):
        importlib.import_module(name)
    load_entry_points('launch.frontend.launch_extension', 'launch extension')


def load_entry_points(group: str, what: str) -> dict[str, Any]:
    """Import what distributions register in a group; warn of what cannot be imported."""
    loaded = {}
    for name, target in sorted(entry_point_index.entry_points(group).items()):
        try:
            loaded[name] = entry_point_index.load(target)
        except Exception as error:
            warnings.warn(f'Failed to load the {what} {name}: {error!r}', stacklevel=2)
    return loaded


# What took the place of substitutions and elements.
_OF_ROS_1 = {
    'arg': '$(var NAME)',
    'find': '$(find-pkg-share PACKAGE)',
    'optenv': '$(env NAME DEFAULT)',
    'rosparam': '<param from="FILE"/> inside of <node>',
}


def _find(name: str, methods: dict[str, Callable[..., Any]], what: str) -> Callable[..., Any]:
    load_extensions()
    if name not in methods:
        near = difflib.get_close_matches(name, list(methods), 1)
        hint = f" (is '{near[0]}' meant?)" if near else ''
        if name in _OF_ROS_1:
            hint = f' (that is of ROS 1: write {_OF_ROS_1[name]})'
        raise RuntimeError(f'{what}{name}{hint}')
    return methods[name]


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """Return the action that an element means."""
    parse = _find(entity.type_name, action_parse_methods, 'Unrecognized entity of the type: ')
    action_type, kwargs = parse(entity, parser)
    action: Action = action_type(**kwargs)
    action._location = entity.location or action._location
    return action


def instantiate_substitution(
    type_name: str, args: Iterable[list[Substitution]] | None = None
) -> Substitution:
    """Return the substitution that ``$(name arguments)`` means."""
    parse = _find(type_name, substitution_parse_methods, 'Unknown substitution: ')
    substitution_type, kwargs = parse(list(args or ()))
    positional = kwargs.pop('args', ())
    substitution: Substitution = substitution_type(*positional, **kwargs)
    return substitution
