# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Classroom 50 keeps of a grading: result.json.

Its fields: https://github.com/foundation50/classroom50/wiki/Advanced-Autograding, "The result.json
contract", version classroom50/result/v1. Scores are whole numbers there.
"""

from collections.abc import Mapping
from datetime import datetime, timezone
import math
import os
from typing import Any

from husky_grader.graded import Graded, StepGrade

_SCHEMA = 'classroom50/result/v1'
# The fields that its runner gives by variables; review is left empty where there is none.
_GIVEN = {
    'classroom': 'CLASSROOM',
    'assignment': 'ASSIGNMENT',
    'assignment_type': 'ASSIGNMENT_TYPE',
    'owner': 'OWNER',
    'submission': 'SUBMISSION_TAG',
    'commit': 'COMMIT_URL',
    'release': 'RELEASE_URL',
}
_ROUNDING = 1e-9  # shares of a sum of decimal fractions


def classroom_result(
    graded: Graded, environment: Mapping[str, str] = os.environ, now: datetime | None = None
) -> dict[str, Any]:
    """
    Return what result.json holds.

    A step's points are rounded down, so that one that lacks some never shows all; its own points
    and the reason stand beside them.

    :param environment: that of the runner of Classroom 50.
    :param now: the time of the grading, with its zone; left out: now.
    :raises ValueError: when the runner's variables are missing.
    """
    missing = [name for name in _GIVEN.values() if not environment.get(name)]
    if missing:
        raise ValueError(
            f'{", ".join(missing)}: not set; only the runner of Classroom 50, which sets them, '
            'takes a result.json'
        )
    given = {field: environment[variable] for field, variable in _GIVEN.items()}
    time = (now or datetime.now(timezone.utc)).astimezone(timezone.utc)
    tests = [_test(step) for step in graded.steps] or [_refused(graded)]
    return {
        'schema': _SCHEMA,
        **given,
        'review': environment.get('REVIEW_URL') or given['commit'],
        'datetime': f'{time:%Y-%m-%dT%H:%M:%SZ}',
        'score': sum(test['score'] for test in tests),
        'max-score': sum(test['max-score'] for test in tests),
        'tests': tests,
    }


def _test(step: StepGrade) -> dict[str, Any]:
    most = math.ceil(step.most)
    share = step.points / step.most if step.most else 0.0
    return {
        'test-name': step.name,
        'passed': step.is_full,
        'score': math.floor(share * most + _ROUNDING),
        'max-score': most,
        'points': round(step.points, 3),
        'why': step.why,
    }


def _refused(graded: Graded) -> dict[str, Any]:
    """Return the one test of a submission that was refused."""
    return {
        'test-name': 'submission',
        'passed': False,
        'score': 0,
        'max-score': math.ceil(graded.most),
        'points': 0.0,
        'why': graded.refused,
    }
