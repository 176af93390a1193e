# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Everything that comes out of a graded class, beside the reports on each submission."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from husky_course.files import replacing

from husky_grader.graded import Graded
from husky_grader.outputs.canvas import CanvasGradebook, write_canvas_feedback
from husky_grader.outputs.class_page import class_page
from husky_grader.outputs.gradebook import FILLED, Gradebook
from husky_grader.outputs.grades_csv import write_grades_csv
from husky_grader.outputs.grades_json import write_grades_json
from husky_grader.outputs.matching import told
from husky_grader.outputs.moodle import MoodleWorksheet, write_moodle_feedback
from husky_grader.outputs.sheet import write_sheet
from husky_grader.outputs.student_page import write_student_page

PAGE, CSV, JSON = 'class.html', 'grades.csv', 'grades.json'
MOODLE_FEEDBACK = f'feedback_for_{MoodleWorksheet.lms}.zip'
CANVAS_FEEDBACK = f'feedback_for_{CanvasGradebook.lms}.zip'
OUTPUT_FILES = (PAGE, CSV, JSON, *FILLED.values(), MOODLE_FEEDBACK, CANVAS_FEEDBACK)
"""Names that no folder of a submission may have."""


@dataclass(frozen=True)
class Outputs:
    """What was written, and what a person should know of it, a line each."""

    files: Sequence[Path]
    notes: Sequence[str]


def write_outputs(
    folder: Path, everyone: Sequence[Graded], *, title: str, gradebook: Gradebook | None = None
) -> Outputs:
    """
    Write the pages, tables and archives of a class, each whole or not at all.

    :param folder: with a folder for the report of each submission, by its id.
    :param gradebook: of the LMS, of which a filled copy is written.
    :raises OSError: when something cannot be written.
    """
    for one in everyone:
        write_student_page(folder / one.submission.id, one)
    write_grades_csv(folder / CSV, everyone)
    write_grades_json(folder / JSON, everyone, title=title)
    names, notes = [CSV, JSON], []
    if gradebook is not None:
        filled, about = gradebook.filled(everyone)
        name = FILLED[gradebook.lms]
        write_sheet(folder / name, filled)
        names.append(name)
        notes += [f'{name}: {note}' for note in about]
    if of_moodle := [one for one in everyone if one.submission.lms == MoodleWorksheet.lms]:
        worksheet = gradebook if isinstance(gradebook, MoodleWorksheet) else None
        path = folder / MOODLE_FEEDBACK
        notes += write_moodle_feedback(path, of_moodle, folder, worksheet)
        names.append(MOODLE_FEEDBACK)
    if of_canvas := [one for one in everyone if one.submission.lms == CanvasGradebook.lms]:
        notes += write_canvas_feedback(folder / CANVAS_FEEDBACK, of_canvas, folder)
        names.append(CANVAS_FEEDBACK)
    notes += left_by_earlier(folder, [PAGE, *names])
    with replacing(folder / PAGE) as part:
        part.write_text(
            class_page(everyone, title=title, notes=notes, files=names), encoding='utf-8'
        )
    return Outputs([folder / name for name in (PAGE, *names)], notes)


def left_by_earlier(folder: Path, written: Sequence[str] = ()) -> list[str]:
    """
    Return a line on tables, pages and archives that another call has left; none without any.

    They are not removed, but may have other grades.

    :param written: names of what the call at hand writes.
    """
    left = (name for name in OUTPUT_FILES if name not in written and (folder / name).exists())
    return told('of an earlier call, and left as it was', left)
