# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The shapes of results that others read, as they document them.

Gradescope: gradescope-autograders.readthedocs.io, "Autograder Specifications", "Leaderboards".
Classroom 50: github.com/foundation50/classroom50, wiki/Advanced-Autograding and the rules of
schemas/result-v1.schema.json, "classroom50/result/v1".
"""

from typing import Any

import jsonschema

_TEXT, _NUMBER = {'type': 'string', 'minLength': 1}, {'type': 'number', 'minimum': 0}
_COUNT = {'type': 'integer', 'minimum': 0}
_VISIBILITY = {'enum': ['hidden', 'after_due_date', 'after_published', 'visible']}
_FORMAT = {'enum': ['text', 'html', 'simple_format', 'md', 'ansi']}
_GRADESCOPE = {
    'type': 'object',
    'additionalProperties': False,
    'anyOf': [{'required': ['score']}, {'required': ['tests']}],
    'properties': {
        'score': {'type': 'number'},
        'execution_time': _NUMBER,
        'output': {'type': 'string'},
        'output_format': _FORMAT,
        'test_output_format': _FORMAT,
        'test_name_format': _FORMAT,
        'visibility': _VISIBILITY,
        'stdout_visibility': _VISIBILITY,
        'extra_data': {'type': 'object'},
        'tests': {
            'type': 'array',
            'items': {
                'type': 'object',
                'additionalProperties': False,
                'properties': {
                    'score': {'type': 'number'},
                    'max_score': {'type': 'number'},
                    'status': {'enum': ['passed', 'failed']},
                    'name': {'type': 'string'},
                    'name_format': _FORMAT,
                    'number': {'type': 'string'},
                    'output': {'type': 'string'},
                    'output_format': _FORMAT,
                    'tags': {'type': 'array', 'items': {'type': 'string'}},
                    'visibility': _VISIBILITY,
                    'extra_data': {'type': 'object'},
                },
            },
        },
        'leaderboard': {
            'type': 'array',
            'items': {
                'type': 'object',
                'additionalProperties': False,
                'required': ['name', 'value'],
                'properties': {
                    'name': _TEXT,
                    'value': {'type': ['number', 'string']},
                    'order': {'enum': ['asc', 'desc']},
                },
            },
        },
    },
}
_TIME = {'type': 'string', 'pattern': r'^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$'}
_CLASSROOM50 = {
    'type': 'object',
    'additionalProperties': False,
    'required': [
        *('schema', 'classroom', 'assignment', 'assignment_type', 'owner', 'submission', 'commit'),
        *('release', 'review', 'datetime', 'score', 'max-score', 'tests'),
    ],
    'properties': {
        'schema': {'const': 'classroom50/result/v1'},
        **dict.fromkeys(('classroom', 'assignment', 'owner'), _TEXT),
        **dict.fromkeys(('commit', 'release', 'review'), _TEXT),
        'assignment_type': {'enum': ['individual', 'group']},
        'submission': {'type': 'string', 'pattern': '^submit/'},
        'datetime': _TIME,
        'graded_at': _TIME,
        'score': _COUNT,
        'max-score': _COUNT,
        'tests': {
            'type': 'array',
            'items': {
                'type': 'object',
                'required': ['test-name', 'passed', 'score', 'max-score'],
                'properties': {
                    'test-name': _TEXT,
                    'passed': {'type': 'boolean'},
                    'score': _COUNT,
                    'max-score': _COUNT,
                },
            },
        },
        'submitted_by': {'type': 'object', 'required': ['username']},
    },
}


def check_gradescope(results: Any) -> None:
    """Hold that Gradescope would take this results.json."""
    jsonschema.validate(results, _GRADESCOPE)


def check_classroom50(result: Any) -> None:
    """Hold that Classroom 50 would take this result.json."""
    jsonschema.validate(result, _CLASSROOM50)
    for part in (result, *result['tests']):
        assert part['score'] <= part['max-score'], part
    for name in ('score', 'max-score'):
        assert sum(test[name] for test in result['tests']) == result[name]
