# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters in markup launch files."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch.frontend import Entity, Parser
from launch.frontend.type_utils import get_data_type_from_identifier

from ..parameter_descriptions import ParameterFile, ParameterValue


def _value(param: Entity, parser: Parser) -> Any:
    """Return the value of a ``param`` element, a dictionary where it holds others."""
    identifier = param.get_attr('type', optional=True)
    data_type = None if identifier is None else get_data_type_from_identifier(identifier)
    value = param.get_attr('value', data_type=data_type, optional=True)
    nested = param.get_attr('param', data_type=list[Entity], optional=True)
    if (value is None) == (not nested):
        raise RuntimeError('a param needs either a value or nested params, and not both')
    if nested:
        if data_type is not None:
            raise RuntimeError('nested parameters and type attributes are mutually exclusive')
        return _dictionary(nested, parser)
    return ParameterValue(parser.parse_if_substitutions(value), value_type=data_type)


def _dictionary(params: Iterable[Entity], parser: Parser) -> dict[Any, Any]:
    values = {}
    for param in params:
        name = tuple(parser.parse_substitution(param.get_attr('name')))
        values[name] = _value(param, parser)
        param.assert_entity_completely_parsed()
    return values


def parse_nested_parameters(params: Iterable[Entity], parser: Parser) -> list[Any]:
    """Return what ``param`` elements mean, as the parameters of a Node."""
    found: list[Any] = []
    for param in params:
        file = param.get_attr('from', optional=True)
        allow_substs = param.get_attr('allow_substs', data_type=bool, optional=True)
        name = param.get_attr('name', optional=True)
        if file is None and name is None:
            raise ValueError('a param needs a name or from')
        if file is not None and name is not None:
            raise RuntimeError('a param has either a name or from, and not both')
        if file is None:
            if allow_substs is not None:
                raise RuntimeError("'allow_substs' can only be used together with 'from'")
            found.append(_dictionary([param], parser))
            continue
        param.assert_entity_completely_parsed()
        allow = parser.parse_if_substitutions(allow_substs)
        found.append(
            ParameterFile(
                parser.parse_substitution(file), allow_substs=False if allow is None else allow
            )
        )
    return found
