# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade what was handed in: unpack it, build and run it in a jail, step by step of a rubric."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from husky_grader.graded import Graded
from husky_grader.jail import Sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.rubric.steps import Rubric, Step
from husky_grader.submission import Refused, Submission, unpack

WORKSPACE = 'handed_in'
"""The folder of a report with the copy of a workspace that was graded."""


def grade_submission(
    submission: Submission,
    rubric: Rubric,
    folder: Path,
    *,
    sandbox: Sandbox,
    real_time_factor: float,
    done: Callable[[Step], None],
) -> Graded:
    """
    Grade one submission; the report goes to a folder of its own.

    :param done: called after each step.
    :raises OSError: when the report cannot be written.
    """
    graded = Graded(submission, rubric.points, sandbox=sandbox.name, notes=submission.notes)
    try:
        workspace = unpack(submission, folder / WORKSPACE)
    except Refused as error:
        return replace(graded, refused=str(error))
    graded = replace(graded, notes=(*submission.notes, *workspace.notes))
    if workspace.kind != 'workspace':
        why = f'{submission.place}: a waypoint file; a workspace with packages is asked for'
        return replace(graded, refused=why)
    try:
        steps = grade_lab(
            workspace.path,
            rubric,
            folder,
            sandbox=sandbox,
            real_time_factor=real_time_factor,
            done=done,
        )
    except ValueError as error:  # it must not stop the others
        return replace(graded, refused=f'{submission.place}: cannot be graded: {error}')
    return replace(graded, steps=steps)
