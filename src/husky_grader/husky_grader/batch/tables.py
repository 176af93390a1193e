# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The grades of many files as a table: for the terminal, and as CSV."""

from collections.abc import Sequence
from pathlib import Path

from husky_course.printable import printable

from husky_grader.file_grading import Grade
from husky_grader.folder_names import folder_names
from husky_grader.report.files import REPORT_FILES
from husky_grader.spreadsheet import write_table

_OUR_FILES = ('grades.csv', '.grades.part.csv', *REPORT_FILES)

COLUMNS = (
    *('file', 'score', 'passed', 'completed', 'waypoints_reached', 'waypoints_total'),
    *('collisions', 'cross_track_rms_m', 'cross_track_max_m', 'min_clearance_m'),
    *('path_length_m', 'driven_m', 'sim_time_sec', 'trajectory_sha256', 'reasons'),
)


def names_of(files: Sequence[str]) -> list[str]:
    """Return for each file the name of a folder of its own: short, and harmless everywhere."""
    places = [path.parent / path.stem for path in map(Path, files)]
    return folder_names(places, taken=_OUR_FILES)


def table(names: Sequence[str], grades: Sequence[Grade]) -> str:
    """Return one line a file: name, score, verdict and the first reason."""
    width = max(map(len, names), default=0)
    lines = []
    for name, grade in zip(names, grades, strict=True):
        file = printable(grade.file)
        refused = [line.removeprefix(f'{file}: ') for line in grade.refused.splitlines()]
        reasons = refused or (grade.report or {})['reasons']
        verdict = 'passed' if grade.passed else 'refused' if grade.refused else 'not passed'
        verdict = 'not graded' if grade.undone else verdict
        more = f' (and {len(reasons) - 1} more)' if len(reasons) > 1 else ''
        reason = reasons[0] + more if reasons else ''
        lines.append(f'{name:<{width}}  {grade.score:5.1f}  {verdict:<10}  {reason}'.rstrip())
    return '\n'.join(map(printable, lines))


def write_csv(path: Path, grades: Sequence[Grade]) -> None:
    """Write one line a file, for a spreadsheet."""
    write_table(path, COLUMNS, map(_row, grades))


def _row(grade: Grade) -> list[object]:
    report = grade.report or {}
    given = {
        'file': grade.file,
        'score': round(grade.score, 2),
        'passed': grade.passed,
        'collisions': len(report.get('collisions', [])),
        'reasons': grade.refused or '; '.join(report.get('reasons', [])),
    }
    return [given.get(column, report.get(column, '')) for column in COLUMNS]
