# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The JSON schema of a rubric, for editors, made from the tables of its fields.

`./lab exec python3 -m husky_grader.rubric.schema > config/rubric.schema.json`
"""

from typing import Any

from husky_course.checked_yaml import file_schema, Table, table_schema

from husky_grader.rubric.tables import RUBRIC, STEPS

DESCRIPTION = 'What a lab asks for, step by step, with the points for it.'


def schema_text() -> str:
    """Return the schema as the text of its file."""
    rubric = table_schema(RUBRIC)
    kinds = [_of_kind(kind, table) for kind, table in STEPS.items()]
    rubric['properties']['steps']['items'] = {'anyOf': kinds}
    return file_schema('Rubric', DESCRIPTION, rubric)


def _of_kind(kind: str, table: Table) -> dict[str, Any]:
    step = table_schema(table)
    step['properties']['kind']['const'] = kind
    return step


if __name__ == '__main__':
    print(schema_text(), end='')
