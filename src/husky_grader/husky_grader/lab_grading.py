# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade what was handed in: unpack it, build and run it in a jail, step by step of a rubric."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from husky_course.printable import printable

from husky_grader.jail import Sandbox
from husky_grader.lab.lab import grade_lab, StepGrade
from husky_grader.rubric.steps import Rubric, Step
from husky_grader.submission import Refused, Submission, unpack

WORKSPACE = 'handed_in'
"""The folder of a report with the copy of a workspace that was graded."""


@dataclass(frozen=True)
class LabGrade:
    """What a submission is worth, step by step, or why it was refused."""

    submission: Submission
    steps: Sequence[StepGrade] = ()
    refused: str = ''

    @property
    def points(self) -> float:
        return sum(step.points for step in self.steps)

    @property
    def most(self) -> float:
        return sum(step.most for step in self.steps)

    @property
    def is_full(self) -> bool:
        """Whether every step got all of its points."""
        return not self.refused and all(step.is_full for step in self.steps)

    def entry(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        return {
            'id': self.submission.id,
            'name': self.submission.name,
            'points': self.points,
            'most': self.most,
            'refused': self.refused or None,
            'steps': [asdict(step) for step in self.steps],
        }

    def line(self, width: int) -> str:
        """Return the line of a table: the name, the points and the first thing to do better."""
        if self.refused:
            return printable(f'{self.submission.id:<{width}}  refused  {self.refused}')
        lacking = next((f'{s.name}: {s.why}' for s in self.steps if not s.is_full), '')
        sum_of = f'{self.points:6.1f} of {self.most:g}'
        return printable(f'{self.submission.id:<{width}}  {sum_of}  {lacking}').rstrip()


def grade_submission(
    submission: Submission,
    rubric: Rubric,
    folder: Path,
    *,
    sandbox: Sandbox,
    real_time_factor: float,
    done: Callable[[Step], None],
) -> LabGrade:
    """
    Grade one submission; the report goes to a folder of its own.

    :param done: called after each step.
    :raises OSError: when the report cannot be written.
    """
    try:
        workspace = unpack(submission, folder / WORKSPACE)
    except Refused as error:
        return LabGrade(submission, refused=str(error))
    if workspace.kind != 'workspace':
        why = f'{submission.place}: a waypoint file; a workspace with packages is asked for'
        return LabGrade(submission, refused=why)
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
        return LabGrade(submission, refused=f'{submission.place}: cannot be graded: {error}')
    return LabGrade(submission, steps)
