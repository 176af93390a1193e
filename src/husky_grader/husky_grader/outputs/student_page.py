# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What one student got, as a page: nothing of others, of hidden courses, or of this machine."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from husky_course.files import replacing
from husky_course.printable import printable

from husky_grader.graded import Graded
from husky_grader.outputs.class_summary import as_points
from husky_grader.report.folder import drives_in, REPORT
from husky_grader.report.page import rendered
from husky_grader.rubric.steps import file_name_of

PAGE = 'index.html'
_TEMPLATE = Path(__file__).with_name('student.html.jinja')
_STYLE = Path(__file__).with_name('class.css')


@dataclass(frozen=True)
class Drive:
    """The report on a drive that its student may see."""

    name: str
    page: Path


def drives_of(folder: Path, graded: Graded) -> list[Drive]:
    """
    Return the reports on the drives of a submission, in the order of its steps.

    Only folders of the grader's own are looked into: in that with the student's files could be
    anything, and in that for the staff are the drives of hidden courses.

    :param folder: of its report.
    """
    found = []
    for step in graded.steps:
        folders = drives_in(folder, file_name_of(step.name))
        found += [Drive(path.name, path / REPORT) for path in folders]
    return list({drive.name: drive for drive in found}.values())


def student_page(graded: Graded, drives: Sequence[tuple[str, str]]) -> str:
    """
    Return the page as HTML text.

    :param drives: names of drives, and where their reports lie, seen from the page.
    """
    one = graded.submission
    return rendered(
        _TEMPLATE,
        [_STYLE],
        graded=graded,
        refused=why_refused(graded),
        drives=drives,
        notes=[note for note in graded.notes if note not in one.notes],
        points=as_points,
    )


def why_refused(graded: Graded) -> str:
    """Return why it was refused, without the place where it lay on this machine."""
    # As it is shown, for that it may be already.
    return printable(graded.refused).removeprefix(f'{printable(graded.submission.place)}: ')


def write_student_page(folder: Path, graded: Graded) -> Path:
    """
    Write the page into the folder of a report, and return its name.

    :raises OSError: when it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    drives = [(each.name, f'{each.name}/{REPORT}') for each in drives_of(folder, graded)]
    with replacing(folder / PAGE) as part:
        part.write_text(student_page(graded, drives), encoding='utf-8')
    return folder / PAGE


def feedback_files(folder: Path, graded: Graded) -> dict[str, bytes]:
    """
    Return what a student gets: the page, and the reports on the drives beside it.

    :param folder: of the report.
    """
    drives = {f'drive_{each.name}.html': each for each in drives_of(folder, graded)}
    page = student_page(graded, [(each.name, name) for name, each in drives.items()])
    files = {name: each.page.read_bytes() for name, each in drives.items()}
    return {'feedback.html': page.encode(), **files}
