# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""YAML files read by a table of their fields; each mistake is told with its line and column."""

from husky_course.checked_yaml.field_reader import choice, FieldReader
from husky_course.checked_yaml.fields import Field, number, Table
from husky_course.checked_yaml.json_schema import file_schema, table_schema
from husky_course.checked_yaml.yaml_tree import FileRefused, parse_yaml, Problem, read_yaml, Value

__all__ = [
    'Field',
    'FieldReader',
    'FileRefused',
    'Problem',
    'Table',
    'Value',
    'choice',
    'file_schema',
    'number',
    'parse_yaml',
    'read_yaml',
    'table_schema',
]
