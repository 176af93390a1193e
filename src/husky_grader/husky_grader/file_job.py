# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The job of grading one waypoint file."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from husky_course.record import FILE_NAME

from husky_grader.batch.job import Outcome
from husky_grader.batch.key import key_of, world_digest
from husky_grader.file_grading import Grade, grade_file
from husky_grader.report.files import is_report, REPORT_FILES


@dataclass(frozen=True)
class FileJob:
    """Drives the course of a file; see `batch.job.Job`."""

    file: str
    name: str
    world: str = ''

    result_file = 'report.json'

    def key(self) -> str:
        return key_of([Path(self.file)], {'world': world_digest(self.world)})

    def is_result(self, content: object) -> bool:
        return is_report(content)

    def forget(self, folder: Path) -> None:
        for name in (*REPORT_FILES, FILE_NAME):
            (folder / name).unlink(missing_ok=True)

    def run(self, folder: Path, alive: Callable[[], object]) -> Outcome:
        self.forget(folder)
        # A class's pictures nobody opens; each page has the same map.
        grade = grade_file(self.file, folder, world=self.world, picture=False, each_second=alive)
        return Outcome(grade.report, grade.refused)

    def grade(self, outcome: Outcome) -> Grade:
        """Return an outcome as the result of the file."""
        content, refused = outcome.content, outcome.refused
        return Grade(self.file, content, refused, refused=refused, undone=outcome.undone)
