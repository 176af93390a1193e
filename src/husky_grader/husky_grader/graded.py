# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a submission got: the points of each step, and why."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from husky_course.printable import printable

from husky_grader.submission import Submission

LAB_FILE = 'lab.json'  # of one, in the folder of its report
RUN_WITH = 'it was run with'  # begins what is told beside the reasons of a step, and is none
DRIVE_PASSED = ' passed'  # ends what is told of a course that was driven right, and is none either


@dataclass(frozen=True)
class StepGrade:
    """One step of a rubric: what it was worth, what it got, and what to do about the rest."""

    name: str
    most: float
    points: float
    why: str
    printed: str = ''  # by its program or the build, shortened

    @property
    def is_full(self) -> bool:
        """Whether it got every point."""
        return self.points >= self.most


@dataclass(frozen=True)
class Graded:
    """A submission with the points of its steps, or why it was refused."""

    submission: Submission
    most: float  # points that the rubric has
    steps: Sequence[StepGrade] = ()
    refused: str = ''
    undone: bool = False  # refused for what this computer lacked: no fault of the submission
    sandbox: str = ''  # in which it was built and run
    notes: Sequence[str] = ()  # what a person should know of how it was found and unpacked

    @property
    def points(self) -> float:
        return sum(step.points for step in self.steps)

    @property
    def is_full(self) -> bool:
        """Whether every step got all of its points."""
        return not self.refused and all(step.is_full for step in self.steps)

    @property
    def instead_of_points(self) -> str:
        """The word for one that has no points."""
        return 'not graded' if self.undone else 'refused' if self.refused else ''

    def entry(self) -> dict[str, Any]:
        """Return it as JSON has it."""
        return {
            'id': self.submission.id,
            'name': self.submission.name,
            'points': self.points,
            'most': self.most,
            'refused': self.refused or None,
            'sandbox': self.sandbox,
            'notes': list(self.notes),
            'steps': [asdict(step) for step in self.steps],
        }

    def said(self) -> str:
        """Return it as progress tells it."""
        return f'{self.submission.id} {self.instead_of_points or f"{self.points:.1f}"}'

    def line(self, width: int) -> str:
        """Return the line of a table: the name, the points and the first thing to do better."""
        if self.refused:
            return printable(
                f'{self.submission.id:<{width}}  {self.instead_of_points}  {self.refused}'
            )
        lacking = next((f'{s.name}: {s.why}' for s in self.steps if not s.is_full), '')
        sum_of = f'{self.points:6.1f} of {self.most:g}'
        return printable(f'{self.submission.id:<{width}}  {sum_of}  {lacking}').rstrip()
