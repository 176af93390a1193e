# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grades and feedback in the forms that an assignment of Moodle takes.

*Download grading worksheet* gives a table, *Upload grading worksheet* takes it. Of its columns
Moodle reads the identifier (a word and the participant's number), the grade, the comments, and
when the grade was last modified: one that was changed since in Moodle is left, and so is one above
the maximum. The header is in the language of the user, and must be when it is uploaded.
Source: importgradeslib.php and locallib.php in mod/assign/feedback/offline, and gradingtable.php
in mod/assign, github.com/moodle/moodle.

*Upload multiple feedback files in a zip* takes folders named as in the export of submissions,
NAME_NUMBER_assignsubmission_file, with the number of a participant also where groups hand in.
Source: mod/assign/feedback/file/importziplib.php.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
import re

from husky_course.printable import printable

from husky_grader.folder_names import composed, harmless
from husky_grader.graded import Graded
from husky_grader.outputs.class_summary import as_points
from husky_grader.outputs.feedback import write_zip
from husky_grader.outputs.matching import match, Matching, told, told_instead
from husky_grader.outputs.sheet import like, number_in, Sheet
from husky_grader.outputs.student_page import feedback_files, why_refused
from husky_grader.submission import Submission

LMS = 'moodle'
_OURS = '<p>Graded by ./lab grade: '  # with this a comment begins that the next one replaces
_NUMBER = re.compile(r'\D*(\d{1,18})\s*', re.ASCII)


@dataclass(frozen=True)
class _Words:
    """Headers in a language, in small letters, and what is said in it where nothing may change."""

    most: str
    comments: str
    group: str
    changeable: str
    no: str


_LANGUAGES = (
    _Words('maximum grade', 'feedback comments', 'group', 'grade can be changed', 'no'),
    _Words(
        *('bestwertung', 'feedback als kommentar', 'gruppe'),
        *('bewertung kann geändert werden', 'nein'),
    ),
    _Words(
        *('note maximale', 'feedback par commentaires', 'groupe'),
        *('la note peut être modifiée', 'non'),
    ),
    _Words(
        *('calificación máxima', 'comentarios de retroalimentación', 'grupo'),
        *('la calificación puede ser cambiada', 'no'),
    ),
)


@dataclass(frozen=True)
class MoodleWorksheet:
    """A grading worksheet: its table, and which columns of it say what."""

    sheet: Sheet
    most: int  # the grade stands before it
    comments: int | None
    group: int | None
    changeable: int | None
    no: str

    lms = LMS

    def rows_of(self, submission: Submission) -> list[int]:
        """Return the rows of those who have handed it in."""
        if submission.lms != LMS:
            return []
        if self.group is None:
            return [
                number
                for number, row in enumerate(self.sheet.rows)
                if submission.user and _participant(row) == submission.user
            ]
        return [
            number
            for number, row in enumerate(self.sheet.rows)
            if self._is_of(row, row[self.group], submission)
        ]

    def _is_of(self, row: Sequence[str], group: str, submission: Submission) -> bool:
        """Tell whether a member of a group has handed it in; up to Moodle 4.0 each has a copy."""
        name = _letters(submission.name)
        is_copy = _participant(row) == submission.user and name == _letters(group + row[1])
        return bool(name) and (is_copy or name == _letters(group))

    def matching(self, everyone: Sequence[Graded]) -> Matching:
        """Return what gets into which row."""
        rows_of = {one.submission.id: self.rows_of(one.submission) for one in everyone}
        return match(everyone, rows_of, self._names())

    def participants(self, everyone: Sequence[Graded]) -> dict[str, list[str]]:
        """Return the numbers of those who have handed in each submission, by its id."""
        numbers: dict[str, list[str]] = {one.submission.id: [] for one in everyone}
        for row, one in self.matching(everyone).graded.items():
            numbers[one.submission.id].append(_participant(self.sheet.rows[row]))
        return numbers

    def _names(self) -> dict[int, str]:
        return {number: f'{row[1]} ({row[0]})' for number, row in enumerate(self.sheet.rows)}

    def filled(self, everyone: Sequence[Graded]) -> tuple[Sheet, list[str]]:
        """
        Return the table with grades and comments, and what a person should know, a line each.

        Who has handed in nothing, was refused or is locked gets no grade. A comment that somebody
        else has written stays.
        """
        matching, names = self.matching(everyone), self._names()
        rows = [list(row) for row in self.sheet.rows]
        instead, locked, changed, commented = [], [], [], []
        for number, one in matching.graded.items():
            row, name = rows[number], names[number]
            if self.comments is not None:
                if row[self.comments].strip() and not row[self.comments].startswith(_OURS):
                    commented.append(name)
                else:
                    row[self.comments] = comment(one)
            if one.refused:
                instead.append((name, one))
            elif self.changeable is not None and self._is_locked(row[self.changeable]):
                locked.append(name)
            else:
                new = self._grade(one, row[self.most])
                if row[self.most - 1].strip() not in ('', new):
                    changed.append(f'{name} {row[self.most - 1].strip()} -> {new}')
                row[self.most - 1] = new
        notes = [
            *matching.notes,
            *told_instead('so no grade is written', instead),
            *told('locked in Moodle, so no grade is written', locked),
            *told('had another grade', changed),
            *told('has a comment already, which stays', commented),
        ]
        if self.comments is None:
            notes.append('no column for comments; turn feedback comments on in the assignment')
        return replace(self.sheet, rows=rows), notes

    def _is_locked(self, cell: str) -> bool:
        return cell.strip().casefold() == self.no

    @staticmethod
    def _grade(one: Graded, most: str) -> str:
        share = min(one.points / one.most, 1.0) if one.most else 0.0
        return like(share * (number_in(most) or 0.0), most)


def moodle_worksheet(sheet: Sheet) -> MoodleWorksheet | None:
    """
    Return the worksheet that a table is; None where it is none.

    :raises ValueError: when its rows have no participants, or no greatest grade.
    """
    header = [cell.strip().casefold() for cell in sheet.header]
    words = next((each for each in _LANGUAGES if each.most in header[2:]), None)
    if words is None:
        return None
    most = header.index(words.most, 2)
    for number, row in enumerate(sheet.rows, 2):
        if not _participant(row):
            why = f'{row[0]!r} names no participant; Moodle writes a word and a number there'
        elif not number_in(row[most]):
            why = f'{row[most]!r} is no greatest grade; give the assignment points, not a scale'
        else:
            continue
        raise ValueError(printable(f'{sheet.path}: line {number} of the table: {why}'))
    at = {name: number for number, name in enumerate(header)}
    return MoodleWorksheet(
        sheet,
        most=most,
        comments=at.get(words.comments),
        group=at.get(words.group),
        changeable=at.get(words.changeable),
        no=words.no,
    )


def comment(one: Graded) -> str:
    """Return the points and reasons as HTML, which Moodle takes comments for."""
    if one.refused:
        return f'{_OURS}{one.instead_of_points}</p><p>{_html(why_refused(one))}</p>'
    steps = (
        f'<li>{_html(step.name)}, {as_points(step.points)} of {as_points(step.most)}: '
        f'{_html(step.why)}</li>'
        for step in one.steps
    )
    return f'{_OURS}{as_points(one.points)} of {as_points(one.most)}</p><ul>{"".join(steps)}</ul>'


def write_moodle_feedback(
    path: Path, everyone: Sequence[Graded], folder: Path, worksheet: MoodleWorksheet | None
) -> list[str]:
    """
    Write the zip of feedback files; return who gets none, and why, a line each.

    :param folder: with a folder for the report of each submission, by its id.
    :param worksheet: tells the members of groups; an export has only the numbers of groups.
    :raises OSError: when it cannot be written.
    """
    if worksheet is not None:
        numbers = worksheet.participants(everyone)
    else:
        numbers = {
            one.submission.id: list(filter(None, [one.submission.user])) for one in everyone
        }
    write_zip(path, _files(everyone, folder, numbers))
    notes = told(
        f'not in {path.name}, for want of a participant',
        (one.submission.id for one in everyone if not numbers[one.submission.id]),
    )
    if worksheet is None:
        notes.append(
            f'{path.name}: where groups hand in, give the grading worksheet as well '
            '(--gradebook FILE); without it Moodle takes their numbers for those of students'
        )
    return notes


def _files(
    everyone: Sequence[Graded], folder: Path, numbers: Mapping[str, Sequence[str]]
) -> Iterator[tuple[str, bytes]]:
    for one in everyone:
        files = feedback_files(folder / one.submission.id, one)
        # An underscore would end the name for Moodle.
        name = harmless(one.submission.name).replace('_', ' ')
        for number in numbers[one.submission.id]:
            for file, content in files.items():
                yield f'{name}_{number}_assignsubmission_file/{file}', content


def _participant(row: Sequence[str]) -> str:
    found = _NUMBER.fullmatch(row[0])
    return found[1] if found else ''


def _letters(name: str) -> str:
    """Return what Moodle leaves of a name when it makes one of a folder of it, and no more."""
    return ''.join(filter(str.isalnum, composed(name))).casefold()


def _html(text: str) -> str:
    return escape(printable(text))
