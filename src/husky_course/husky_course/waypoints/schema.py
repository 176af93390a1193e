# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The JSON schema of a waypoint file, for editors, made from the table of its fields.

`./lab exec python3 -m husky_course.waypoints.schema > config/waypoints.schema.json`
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
import json
from typing import Any

from husky_course.waypoints.course import (
    Choice,
    Course,
    COURSE_FIELDS,
    Field,
    Number,
    REQUIRED_OF_A_WAYPOINT,
    Waypoint,
    WAYPOINT_FIELDS,
    Waypoints,
)

DESCRIPTION = (
    'A course for the Husky: metres, radians, seconds; x forward and y left of where it starts.'
)


def schema_text() -> str:
    """Return the schema as the text of its file."""
    schema = {
        '$schema': 'https://json-schema.org/draft/2020-12/schema',
        'title': 'Waypoint file',
        'description': DESCRIPTION,
        **_mapping(COURSE_FIELDS, ('waypoints',), Course),
    }
    return json.dumps(schema, indent=2) + '\n'


def _mapping(
    table: Mapping[str, Field], required: tuple[str, ...], made: type[Course | Waypoint]
) -> dict[str, Any]:
    defaults = {entry.name: entry.default for entry in fields(made)}
    properties = {}
    for name, entry in table.items():
        properties[name] = {'description': entry.description, **_schema(entry)}
        if name not in required and defaults[entry.attribute] is not None:
            properties[name]['default'] = defaults[entry.attribute]
    return {
        'type': 'object',
        'required': list(required),
        'additionalProperties': False,
        'properties': properties,
    }


def _schema(entry: Field) -> dict[str, Any]:
    if isinstance(entry, Number):
        return {'type': 'number', 'minimum': entry.low, 'maximum': entry.high}
    if isinstance(entry, Choice):
        return {'enum': list(entry.words)}
    if not isinstance(entry, Waypoints):
        return {'type': 'boolean'}
    pair = [_schema(WAYPOINT_FIELDS[name]) for name in REQUIRED_OF_A_WAYPOINT]
    point = _mapping(WAYPOINT_FIELDS, REQUIRED_OF_A_WAYPOINT, Waypoint)
    return {
        'type': 'array',
        'minItems': entry.least,
        'maxItems': entry.most,
        'items': {
            'anyOf': [
                {'type': 'array', 'prefixItems': pair, 'minItems': 2, 'maxItems': 2},
                point,
            ]
        },
    }


if __name__ == '__main__':
    print(schema_text(), end='')
