# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grades of a class as CSV, for a spreadsheet: a line each, a column for each step."""

from collections.abc import Sequence
from pathlib import Path

from husky_grader.graded import Graded
from husky_grader.outputs.class_summary import BETWEEN
from husky_grader.spreadsheet import write_table

_BEFORE = ('id', 'name', 'user', 'emails', 'late', 'points', 'most', 'refused')


def write_grades_csv(path: Path, everyone: Sequence[Graded]) -> None:
    """
    Write the table, whole or not at all.

    :raises OSError: when it cannot be written.
    """
    most = {step.name: step.most for one in everyone for step in one.steps}
    header = [*_BEFORE, *(f'{name} (of {most[name]:g})' for name in most), 'why']
    write_table(path, header, (_row(one, list(most)) for one in everyone))


def _row(one: Graded, steps: Sequence[str]) -> list[object]:
    by_name = {step.name: round(step.points, 2) for step in one.steps}
    lacking = (f'{step.name}: {step.why}' for step in one.steps if not step.is_full)
    return [
        one.submission.id,
        one.submission.name,
        one.submission.user,
        ' '.join(one.submission.emails),
        'late' if one.submission.late else '',
        round(one.points, 2),
        one.most,
        one.refused,
        *(by_name.get(name) for name in steps),
        BETWEEN.join(lacking),
    ]
