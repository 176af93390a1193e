# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Settings: fields of frozen dataclasses that are also ROS parameters, each declared once.

This module does not import rclpy, so that what is configured runs without it; `parameters`
declares the settings on a node.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
import math
from typing import Any

NODE_PARAMETERS = ('use_sim_time', 'start_type_description_service')  # rclpy's own

_KINDS = {bool: 'true or false', int: 'a whole number', str: 'a text'}


@dataclass(frozen=True, kw_only=True)
class Setting:
    """One field as a parameter: its default, and which values are allowed."""

    name: str
    default: Any
    description: str
    low: float  # of numbers; low == high: any
    high: float
    choices: tuple[str, ...]
    changeable: bool  # while the node runs
    or_zero: bool  # 0 is allowed as well, below the range

    @property
    def has_range(self) -> bool:
        return self.low < self.high

    @property
    def allowed(self) -> str:
        """Return in a few words which values are allowed."""
        if self.choices:
            return f'one of {", ".join(self.choices)}'
        if self.has_range:
            whole = 'whole ' if isinstance(self.default, int) else ''
            zero = '0 or ' if self.or_zero else ''
            return f'{zero}a {whole}number from {self.low:.10g} to {self.high:.10g}'
        return _KINDS.get(type(self.default), 'numbers')

    def checked(self, given: Any, refuse: Refuse) -> Any:
        """
        Return a given value in the type of the default; a person may write 1 for 1.0.

        :param refuse: makes the exception to raise for a value that is not allowed.
        """
        if given is False and 'off' in self.choices:
            return 'off'  # YAML reads a bare off as false
        if isinstance(self.default, tuple):
            if not isinstance(given, Iterable) or not all(map(_is_finite, given)):
                raise refuse(self, given)
            return tuple(map(float, given))
        if self.has_range and not (_is_number(given) and self._is_in_range(given)):
            raise refuse(self, given)
        if isinstance(self.default, float):
            if not _is_number(given):
                raise refuse(self, given)
            return float(given)
        if type(given) is not type(self.default) or (self.choices and given not in self.choices):
            raise refuse(self, given)
        return given

    def _is_in_range(self, given: float) -> bool:
        return self.low <= given <= self.high or (self.or_zero and given == 0)


Refuse = Callable[[Setting, Any], Exception]
"""Makes the exception that says why a value of a setting is not allowed."""


def setting(
    default: Any,
    description: str,
    low: float = 0.0,
    high: float = 0.0,
    *,
    choices: Iterable[str] = (),
    changeable: bool = False,
    or_zero: bool = False,
) -> Any:
    """Declare a field of a dataclass that is also a ROS parameter; low < high is its range."""
    metadata = {'description': description, 'low': low, 'high': high, 'changeable': changeable}
    metadata |= {'or_zero': or_zero, 'choices': tuple(choices)}
    return field(default=default, metadata=metadata)


def settings_of(kind: Any) -> list[Setting]:
    """Return the settings among the fields of a dataclass."""
    return [
        Setting(name=entry.name, default=entry.default, **entry.metadata)
        for entry in fields(kind)
        if entry.metadata
    ]


def names_of(*kinds: Any) -> list[str]:
    """Return the names of the settings of dataclasses."""
    return [each.name for kind in kinds for each in settings_of(kind)]


def refuse_unknown(given: Iterable[str], settings: Iterable[str]) -> None:
    """
    Refuse parameters that are not settings: a typing mistake would go unnoticed.

    :param given: the names of the parameters that a node was given.
    :param settings: the names of those that it has.
    :raises ValueError: naming the first one and the nearest right spelling.
    """
    known = sorted(settings)
    for name in sorted(set(given) - set(known) - set(NODE_PARAMETERS)):
        if not name.startswith('qos_overrides.'):
            near = get_close_matches(name, known, n=1, cutoff=0.5)
            hint = f'did you mean {near[0]}? ' if near else ''
            allowed = ', '.join(known)
            raise ValueError(f'parameter {name} does not exist; {hint}allowed: {allowed}')


def _is_number(given: Any) -> bool:
    return isinstance(given, (int, float)) and not isinstance(given, bool)


def _is_finite(given: Any) -> bool:
    return _is_number(given) and math.isfinite(given)
