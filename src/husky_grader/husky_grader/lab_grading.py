# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade what was handed in: unpack it, build and run it in a jail, step by step of a rubric."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
import shutil

from husky_grader.graded import Graded, LAB_FILE
from husky_grader.jail import own_turn, Sandbox
from husky_grader.lab.drive_step import FOR_STAFF
from husky_grader.lab.lab import grade_lab, grade_path
from husky_grader.report.folder import drives_in
from husky_grader.rubric.steps import Rubric, Step
from husky_grader.submission import Refused, Submission, unpack
from husky_grader.submission.limits import COPY, IGNORED


def grade_submission(
    submission: Submission,
    rubric: Rubric,
    folder: Path,
    *,
    sandbox: Sandbox | None,
    real_time_factor: float = 1.0,
    done: Callable[[Step], None] = lambda _step: None,
    alive: Callable[[], object] = lambda: None,
) -> Graded:
    """
    Grade one submission; the report goes to a folder of its own.

    :param sandbox: where what was handed in is built and run; a rubric of files needs none.
    :param done: called after each step.
    :param alive: called now and then.
    :raises OSError: when the report cannot be written.
    """
    name = sandbox.name if sandbox else ''
    graded = Graded(submission, rubric.points, sandbox=name, notes=submission.notes)
    forget_earlier(folder, rubric)
    copy = folder / COPY
    copy.mkdir(parents=True, exist_ok=True)
    (copy / IGNORED).touch()
    try:
        given = unpack(submission, copy)
    except Refused as error:
        return replace(graded, refused=str(error))
    graded = replace(graded, notes=(*submission.notes, *given.notes))
    if rubric.is_of_files != (given.kind == 'waypoints'):
        asked = 'a waypoint file' if rubric.is_of_files else 'a workspace with packages'
        here = 'a workspace' if rubric.is_of_files else 'a waypoint file'
        why = f'{submission.place}: {here}; the rubric {rubric.title!r} asks for {asked}'
        return replace(graded, refused=why)
    try:
        if sandbox is None:
            steps = grade_path(given.path, rubric, folder, done=alive)
        else:
            with own_turn(sandbox):
                steps = grade_lab(
                    given.path,
                    rubric,
                    folder,
                    sandbox=sandbox,
                    real_time_factor=real_time_factor,
                    done=done,
                    alive=alive,
                )
    except ValueError as error:  # it must not stop the others
        return replace(graded, refused=f'{submission.place}: cannot be graded: {error}')
    return replace(graded, steps=steps)


def forget_earlier(folder: Path, rubric: Rubric) -> None:
    """Remove what an earlier grading left: of an older submission, or of what is hidden now."""
    shutil.rmtree(folder / COPY, ignore_errors=True)
    (folder / LAB_FILE).unlink(missing_ok=True)
    for step in rubric.steps:
        (folder / f'{step.file_name}.log').unlink(missing_ok=True)
        for place in (folder, folder / FOR_STAFF):
            for drive in drives_in(place, step.file_name):
                shutil.rmtree(drive, ignore_errors=True)
