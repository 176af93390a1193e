# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The job of grading one submission by a rubric."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache
import json
from pathlib import Path
from typing import Any

from husky_course.files import replacing

from husky_grader.batch.job import Outcome
from husky_grader.batch.key import key_of, versions, world_digest
from husky_grader.graded import Graded, LAB_FILE, StepGrade
from husky_grader.jail import find_sandbox, MissingSandbox, NoSandbox, Sandbox
from husky_grader.lab_grading import forget_earlier, grade_submission
from husky_grader.rubric.steps import Rubric
from husky_grader.submission import digest_of, Submission

_FIELDS: dict[str, type | tuple[type, ...]] = {
    'rubric': str,
    'sandbox': str,
    'versions': dict,
    'notes': list,
    'score': (int, float),
    'most': (int, float),
    'steps': list,
}


@dataclass(frozen=True)
class LabJob:
    """Grades a submission, step by step; see `batch.job.Job`."""

    submission: Submission
    name: str
    rubric: Rubric
    sandbox: str  # its name; empty: the rubric runs nothing that was handed in
    real_time_factor: float = 1.0

    result_file = LAB_FILE

    def key(self) -> str:
        # What ran without a jail may have written what it liked, also its own result.
        jailed = self.sandbox != 'none'
        return key_of(
            self.rubric.files,
            {
                'handed in': digest_of(self.submission),
                'jailed': jailed,
                'real_time_factor': self.real_time_factor,
                'world': world_digest(self.rubric.world),
            },
        )

    def is_result(self, content: object) -> bool:
        return (
            isinstance(content, dict)
            and set(content) == set(_FIELDS)
            and all(isinstance(content[name], kind) for name, kind in _FIELDS.items())
        )

    def forget(self, folder: Path) -> None:
        forget_earlier(folder, self.rubric)

    def run(self, folder: Path, alive: Callable[[], object]) -> Outcome:
        graded = grade_submission(
            self.submission,
            self.rubric,
            folder,
            sandbox=_sandbox(self.sandbox) if self.sandbox else None,
            real_time_factor=self.real_time_factor,
            alive=alive,
        )
        if graded.refused:
            return Outcome(None, graded.refused)
        return Outcome(write_result(graded, self.rubric, folder))

    def graded(self, outcome: Outcome) -> Graded:
        """Return an outcome as what the submission got."""
        if outcome.content is None:
            notes = self.submission.notes
            return Graded(
                self.submission,
                self.rubric.points,
                refused=outcome.refused,
                undone=outcome.undone,
                notes=notes,
            )
        return from_result(self.submission, outcome.content)


def write_result(graded: Graded, rubric: Rubric, folder: Path) -> dict[str, Any]:
    """
    Write lab.json, whole or not at all; return what it holds.

    How the submission was found is not in it: the next call may find the same one elsewhere.
    """
    content: dict[str, Any] = {
        'rubric': rubric.title,
        'sandbox': graded.sandbox,
        'versions': versions(),
        'notes': [note for note in graded.notes if note not in graded.submission.notes],
        'score': graded.points,
        'most': graded.most,
        'steps': [asdict(step) for step in graded.steps],
    }
    with replacing(folder / LAB_FILE) as part:
        part.write_text(json.dumps(content, indent=2) + '\n', encoding='utf-8')
    return content


def from_result(submission: Submission, content: Mapping[str, Any]) -> Graded:
    """Return what a submission got, of what lab.json holds."""
    return Graded(
        submission,
        content['most'],
        [StepGrade(**step) for step in content['steps']],
        sandbox=content['sandbox'],
        notes=(*submission.notes, *content['notes']),
    )


@lru_cache(maxsize=1)
def _sandbox(name: str) -> Sandbox:
    try:
        return find_sandbox(name)
    except NoSandbox as error:  # what is refused anyhow needs none
        return MissingSandbox(name, str(error))
