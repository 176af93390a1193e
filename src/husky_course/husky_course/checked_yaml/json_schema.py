# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""JSON schemas for editors, made from the tables of fields."""

from dataclasses import fields, MISSING
import json
from typing import Any

from husky_course.checked_yaml.fields import Field, Table

_NOT_SHOWN = (None, MISSING, '', ())  # defaults that tell nothing


def file_schema(title: str, description: str, content: dict[str, Any]) -> str:
    """Return the text of a schema's file."""
    head = {
        '$schema': 'https://json-schema.org/draft/2020-12/schema',
        'title': title,
        'description': description,
    }
    return json.dumps(head | content, indent=2) + '\n'


def table_schema(table: Table) -> dict[str, Any]:
    """Return the schema of a mapping, with the defaults of the dataclass that it becomes."""
    defaults = {entry.name: entry.default for entry in fields(table.made)}
    properties = {}
    for name, field in table.fields.items():
        properties[name] = {'description': field.description, **_schema(field)}
        default = defaults.get(field.attribute)
        if field.table is None and name not in table.required and default not in _NOT_SHOWN:
            properties[name]['default'] = default
    return {
        'type': 'object',
        'required': table.required,
        'additionalProperties': False,
        'properties': properties,
    }


def _schema(field: Field) -> dict[str, Any]:
    if field.table is None:
        return dict(field.schema)
    inner = table_schema(field.table)
    return {**field.schema, 'items': inner} if field.schema['type'] == 'array' else inner
