# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The JSON schema of a waypoint file, for editors, made from the table of its fields.

`./lab exec python3 -m husky_course.waypoints.schema > config/waypoints.schema.json`
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields
import json
from typing import Any

from husky_course.waypoints.course import (
    Course,
    COURSE_FIELDS,
    Field,
    REQUIRED_OF_A_WAYPOINT,
    Waypoint,
    WAYPOINT_FIELDS,
)

DESCRIPTION = (
    'A course for the Husky: metres, radians, seconds; x forward and y left of where it starts.'
)


def schema_text() -> str:
    """Return the schema as the text of its file."""
    course = _mapping(COURSE_FIELDS, ('waypoints',), Course)
    pair = [WAYPOINT_FIELDS[name].schema for name in REQUIRED_OF_A_WAYPOINT]
    kinds = [
        {'type': 'array', 'prefixItems': pair, 'minItems': 2, 'maxItems': 2},
        _mapping(WAYPOINT_FIELDS, REQUIRED_OF_A_WAYPOINT, Waypoint),
    ]
    course['properties']['waypoints']['items'] = {'anyOf': kinds}
    head = {
        '$schema': 'https://json-schema.org/draft/2020-12/schema',
        'title': 'Waypoint file',
        'description': DESCRIPTION,
    }
    return json.dumps(head | course, indent=2) + '\n'


def _mapping(
    table: Mapping[str, Field], required: Sequence[str], made: type[Course | Waypoint]
) -> dict[str, Any]:
    defaults = {entry.name: entry.default for entry in fields(made)}
    properties = {}
    for name, field in table.items():
        properties[name] = {'description': field.description, **field.schema}
        if name not in required and defaults[field.attribute] is not None:
            properties[name]['default'] = defaults[field.attribute]
    return {
        'type': 'object',
        'required': required,
        'additionalProperties': False,
        'properties': properties,
    }


if __name__ == '__main__':
    print(schema_text(), end='')
