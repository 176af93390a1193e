# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Tables of the fields that a file may hold.

The reader reads by them, see `field_reader`; the schema for editors is made from them, see
`json_schema`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Field:
    """
    A field of a file: the attribute it becomes, and the JSON schema of its value.

    :param table: of a mapping, or of each mapping in a list.
    :param parse: makes of a text what it stands for; raises ValueError with what is allowed.
    :param example: how a line of a list is written.
    """

    attribute: str
    description: str
    schema: Mapping[str, Any]
    unit: str = ''
    table: Table | None = None
    parse: Callable[[str], object] | None = None
    example: str = '- ...'


@dataclass(frozen=True)
class Table:
    """A kind of mapping: what it is called, the dataclass it becomes, its fields."""

    noun: str
    made: type[Any]
    fields: Mapping[str, Field]
    required: tuple[str, ...] = ()


def number(low: float, high: float) -> Mapping[str, Any]:
    """Return the schema of a number within limits."""
    return {'type': 'number', 'minimum': low, 'maximum': high}
