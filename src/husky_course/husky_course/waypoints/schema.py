# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The JSON schema of a waypoint file, for editors, made from the table of its fields.

`./lab exec python3 -m husky_course.waypoints.schema > config/waypoints.schema.json`
"""

from husky_course.checked_yaml import file_schema, table_schema
from husky_course.waypoints.course import COURSE, WAYPOINT

DESCRIPTION = (
    'A course for the Husky: metres, radians, seconds; x forward and y left of where it starts.'
)


def schema_text() -> str:
    """Return the schema as the text of its file."""
    course = table_schema(COURSE)
    pair = [WAYPOINT.fields[name].schema for name in WAYPOINT.required]
    kinds = [
        {'type': 'array', 'prefixItems': pair, 'minItems': 2, 'maxItems': 2},
        table_schema(WAYPOINT),
    ]
    course['properties']['waypoints']['items'] = {'anyOf': kinds}
    return file_schema('Waypoint file', DESCRIPTION, course)


if __name__ == '__main__':
    print(schema_text(), end='')
