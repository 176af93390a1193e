# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grades and feedback in the forms that Canvas takes.

*Export* of the gradebook gives a table, *Import* takes it: students, then a column for each
assignment, `NAME (NUMBER)`; its second or third row says the points possible. What stands in a
column is taken over, so only that of the assignment is given back. Source: gradebook_exporter.rb
and gradebook_importer.rb in lib, github.com/instructure/canvas-lms.

*Upload Submissions* takes the files that were downloaded. It reads the numbers of the user and of
the file that was handed in out of their names, and shows the new file under the name of that one;
so the feedback is an archive where an archive was handed in. Source:
infer_comment_context_from_filename in app/models/abstract_assignment.rb.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
import re

from husky_course.printable import printable

from husky_grader.graded import Graded
from husky_grader.outputs.class_summary import as_points
from husky_grader.outputs.feedback import as_tar_gz, as_zip, write_zip
from husky_grader.outputs.matching import match, told, told_instead
from husky_grader.outputs.sheet import like, number_in, Sheet
from husky_grader.outputs.student_page import feedback_files, why_refused
from husky_grader.submission import Submission

LMS = 'canvas'
_ABOUT_STUDENTS = (
    *('Student', 'LastName', 'FirstName', 'ID', 'SIS User ID', 'SIS Login ID'),
    *('Integration ID', 'Root Account', 'Section'),
)
_ASSIGNMENT = re.compile(r'(?P<name>.*\S) \((?P<number>\d+)\)', re.DOTALL | re.ASCII)
_TOTALS = re.compile(r'(Current|Final|Override) (Score|Points|Grade|Status)')
_POSSIBLE = 'Points Possible'
_READ_ONLY = re.compile(r'read\s+only')
# What a person has decided of a student: excused, or the assignment is not theirs.
_DECIDED = ('EX', 'N/A')


@dataclass(frozen=True)
class CanvasGradebook:
    """A gradebook: its table, and which column is that of the assignment."""

    sheet: Sheet
    assignment: int
    possible: str  # points

    lms = LMS

    def rows_of(self, submission: Submission) -> list[int]:
        """Return the rows of those who have handed it in; of a group, Canvas names one."""
        if submission.lms != LMS:
            return []
        at = self.sheet.header.index('ID')
        return [n for n, row in enumerate(self.sheet.rows) if row[at].strip() == submission.user]

    def filled(self, everyone: Sequence[Graded]) -> tuple[Sheet, list[str]]:
        """
        Return the students with the column of the assignment, and what a person should know.

        Who has handed in nothing, was refused or is excused gets no score.
        """
        rows_of = {one.submission.id: self.rows_of(one.submission) for one in everyone}
        at = self.sheet.header.index('ID')
        names = {n: row[0] for n, row in enumerate(self.sheet.rows) if row[at].strip().isdigit()}
        matching = match(everyone, rows_of, names)
        rows = [list(row) for row in self.sheet.rows]
        instead, decided, changed = [], [], []
        for number, one in matching.graded.items():
            row, name = rows[number], names[number]
            before = row[self.assignment].strip()
            new = self._score(one)
            if one.refused:
                instead.append((name, one))
            elif before in _DECIDED:
                decided.append(f'{name} {before}')
            else:
                row[self.assignment] = new
                if before not in ('', new):
                    changed.append(f'{name} {before} -> {new}')
        kept = [n for n, cell in enumerate(self.sheet.header) if cell in _ABOUT_STUDENTS]
        kept.append(self.assignment)
        filled = replace(
            self.sheet,
            header=[self.sheet.header[n] for n in kept],
            rows=[[row[n] for n in kept] for row in rows],
        )
        return filled, [
            *matching.notes,
            *told_instead('so no score is written', instead),
            *told('excused or without the assignment, so no score is written', decided),
            *told('had another score', changed),
        ]

    def _score(self, one: Graded) -> str:
        share = one.points / one.most if one.most else 0.0
        return like(share * (number_in(self.possible) or 0.0), self.possible)


def canvas_gradebook(sheet: Sheet, title: str) -> CanvasGradebook | None:
    """
    Return the gradebook that a table is; None where it is none.

    :param title: of the assignment; needed only where the table has several.
    :raises ValueError: when it is not clear which assignment is graded, or for how many points.
    """
    header = sheet.header
    if tuple(header[:2]) not in (('Student', 'ID'), ('LastName', 'FirstName')):
        return None
    if not {'ID', 'Section'} <= set(header):
        return None
    possible = next((row for row in sheet.rows if row[0].strip() == _POSSIBLE), None)
    if possible is None:
        raise ValueError(
            printable(f'{sheet.path}: it has no row {_POSSIBLE}; give the gradebook as exported')
        )
    columns = {
        number: name
        for number, name in enumerate(header)
        if _ASSIGNMENT.fullmatch(name)
        and not _TOTALS.search(name)
        and not _READ_ONLY.search(possible[number])
    }
    titled = [
        number for number, name in columns.items() if name.rpartition(' (')[0].strip() == title
    ]
    found = list(columns) if len(columns) == 1 else titled
    if len(found) != 1:
        have = ', '.join(columns.values()) or 'none'
        raise ValueError(
            printable(
                f'{sheet.path}: one column with scores is needed, {title!r} or the only one; it '
                f'has: {have}; delete those of other assignments in a copy, and give that'
            )
        )
    points = possible[found[0]]
    if not number_in(points):
        raise ValueError(
            printable(
                f'{sheet.path}: {header[found[0]]} has {points!r} points possible; give it a '
                'number above 0 in Canvas'
            )
        )
    return CanvasGradebook(sheet, found[0], points)


def write_canvas_feedback(path: Path, everyone: Sequence[Graded], folder: Path) -> list[str]:
    """
    Write the zip of feedback files; return who gets none, a line each.

    :param folder: with a folder for the report of each submission, by its id.
    :raises OSError: when it cannot be written.
    """
    with_file = [one for one in everyone if _handed_file(one.submission)]
    write_zip(path, (_file(one, folder) for one in with_file))
    without = (one.submission.id for one in everyone if not _handed_file(one.submission))
    return told(f'not in {path.name}, for want of a file that was handed in', without)


def _handed_file(submission: Submission) -> str:
    """Return the newest file that was handed in, as Canvas has named it; nothing for a folder."""
    # A text or a link has no number; who unpacks an export may leave a folder of its name.
    if submission.lms != LMS or not (submission.attempt and submission.files):
        return ''
    name = PurePosixPath(submission.files[-1][0]).name
    return name.encode(errors='replace').decode()  # in a folder, it may be no text


def _file(one: Graded, folder: Path) -> tuple[str, bytes]:
    files = feedback_files(folder / one.submission.id, one)
    name = _handed_file(one.submission)
    if one.submission.kind == 'zip':
        return name, as_zip(files)
    if one.submission.kind == 'tar':
        return name, as_tar_gz(files)
    return name, _as_text(one).encode()


def _as_text(one: Graded) -> str:
    """Return the points and reasons for whoever has handed in no archive."""
    if one.refused:
        return printable(f'{one.instead_of_points}: {why_refused(one)}') + '\n'
    steps = (
        f'{step.name}, {as_points(step.points)} of {as_points(step.most)}: {step.why}'
        for step in one.steps
    )
    lines = [f'{as_points(one.points)} of {as_points(one.most)}', *steps]
    return ''.join(f'{printable(line)}\n' for line in lines)
