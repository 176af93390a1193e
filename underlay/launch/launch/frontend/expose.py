# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The names of actions and substitutions in markup launch files."""

from __future__ import annotations

from collections.abc import Callable
import difflib
import functools
import importlib
from typing import Any, TYPE_CHECKING, TypeVar
import warnings

from entry_point_index import entry_points, load

if TYPE_CHECKING:
    from ..action import Action
    from ..substitution import Substitution
    from .entity import Entity
    from .parser import Parser

action_parse_methods: dict[str, Callable[[Any, Any], Any]] = {}
substitution_parse_methods: dict[str, Callable[[Any], Any]] = {}

_Exposed = TypeVar('_Exposed')


def _expose(
    name: str, methods: dict[str, Callable[..., Any]], kind: str
) -> Callable[[_Exposed], _Exposed]:
    def decorator(exposed: _Exposed) -> _Exposed:
        parse = getattr(exposed, 'parse', None) if isinstance(exposed, type) else exposed
        if not callable(parse):
            raise RuntimeError(f"exposed {kind} '{name}' needs a method 'parse'")
        known = methods.get(name)
        if known is not None and known != parse:
            raise RuntimeError(f"two {kind}s are exposed under the name '{name}'")
        methods[name] = parse
        return exposed

    return decorator


def expose_substitution(name: str) -> Callable[[_Exposed], _Exposed]:
    """Make a class known as ``$(name ...)``."""
    return _expose(name, substitution_parse_methods, 'substitution')


def expose_action(name: str) -> Callable[[_Exposed], _Exposed]:
    """Make a class, or a function that parses, known as the element ``name``."""
    return _expose(name, action_parse_methods, 'action')


@functools.cache
def load_extensions() -> None:
    """Import what belongs to launch, and what distributions register."""
    for name in ('launch.actions', 'launch.substitutions'):
        importlib.import_module(name)
    for name, target in entry_points('launch.frontend.launch_extension').items():
        try:
            load(target)
        except Exception as error:
            warnings.warn(f'Failed to load the launch extension {name}: {error}', stacklevel=2)


def _find(name: str, methods: dict[str, Callable[..., Any]], what: str) -> Callable[..., Any]:
    load_extensions()
    if name not in methods:
        near = difflib.get_close_matches(name, list(methods), 1)
        hint = f" (is '{near[0]}' meant?)" if near else ''
        raise RuntimeError(f'{what}{name}{hint}')
    return methods[name]


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """Return the action that an element means."""
    parse = _find(entity.type_name, action_parse_methods, 'Unrecognized entity of the type: ')
    action_type, kwargs = parse(entity, parser)
    action: Action = action_type(**kwargs)
    action._location = entity.location or action._location
    return action


def instantiate_substitution(name: str, arguments: list[list[Substitution]]) -> Substitution:
    """Return the substitution that ``$(name arguments)`` means."""
    parse = _find(name, substitution_parse_methods, 'Unknown substitution: ')
    substitution_type, kwargs = parse(arguments)
    args = kwargs.pop('args', ())
    substitution: Substitution = substitution_type(*args, **kwargs)
    return substitution
