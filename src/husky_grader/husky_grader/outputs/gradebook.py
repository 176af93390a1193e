# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The table of an LMS that is to be filled with grades, checked before anything is graded."""

from collections.abc import Sequence
from pathlib import Path
from typing import TypeAlias

from husky_course.printable import printable

from husky_grader.outputs.canvas import canvas_gradebook, CanvasGradebook
from husky_grader.outputs.moodle import moodle_worksheet, MoodleWorksheet
from husky_grader.outputs.sheet import read_sheet
from husky_grader.run.diagnosis import shortened
from husky_grader.submission import Submission

Gradebook: TypeAlias = MoodleWorksheet | CanvasGradebook

FILLED = {lms: f'grades_for_{lms}.csv' for lms in (MoodleWorksheet.lms, CanvasGradebook.lms)}
"""The name of the filled copy, by the LMS."""


def read_gradebook(path: Path, submissions: Sequence[Submission], *, title: str = '') -> Gradebook:
    """
    Read the grading worksheet of Moodle or the gradebook of Canvas.

    :param submissions: at least one of them must be in it.
    :param title: of the assignment; needed only where a gradebook has several.
    :raises ValueError: when it is not understood; one line that says what to do.
    :raises OSError: when it cannot be read.
    """
    if path.name in FILLED.values():
        raise ValueError(printable(f'{path}: written by the grader; give the one of the LMS'))
    sheet = read_sheet(path)
    book = moodle_worksheet(sheet) or canvas_gradebook(sheet, title)
    if book is None:
        have = shortened(', '.join(sheet.header)) or 'none'
        raise ValueError(
            printable(
                f'{path}: neither a grading worksheet of Moodle (Identifier, .., Grade, Maximum '
                'grade, ..; in English, German, French or Spanish) nor a gradebook of Canvas '
                f'(Student, ID, .., Section, NAME (NUMBER), ..); its columns: {have}'
            )
        )
    if not any(map(book.rows_of, submissions)):
        raise ValueError(
            printable(
                f'{path}: nobody who has handed in is in it; give it together with the export of '
                f'the same assignment from {book.lms.capitalize()}'
            )
        )
    return book
