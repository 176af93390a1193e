# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Gradescope shows of a grading: results.json.

Its fields: https://gradescope-autograders.readthedocs.io/en/latest/specs/, and .../leaderboards/.
"""

from collections.abc import Mapping
import json
from pathlib import Path
from typing import Any

from husky_course.printable import printable

from husky_grader.graded import Graded, StepGrade
from husky_grader.lab.drive_step import drive_folders
from husky_grader.rubric.steps import DriveStep, PathStep, Rubric

REPORT_FILE = 'report.json'


def gradescope_results(
    graded: Graded, rubric: Rubric, folder: Path, *, took_sec: float
) -> dict[str, Any]:
    """
    Return what results.json holds: a test for each step, and the leaderboard.

    :param folder: of the report.
    :param took_sec: how long the grading took, in wall time.
    """
    how = f'Built and run in the sandbox "{graded.sandbox}".' if graded.sandbox else ''
    first = f'Not graded: {graded.refused}' if graded.refused else how
    return {
        'score': round(graded.points, 3),
        'execution_time': round(took_sec),
        'output': printable('\n'.join(filter(None, (first, *graded.notes))), keep='\n'),
        # Students have written some of it: no HTML of theirs may be shown.
        'output_format': 'text',
        'test_output_format': 'text',
        'test_name_format': 'text',
        'visibility': 'visible',
        'stdout_visibility': 'hidden',  # it is for the staff
        'tests': [_test(step) for step in graded.steps],
        'leaderboard': _leaderboard(rubric, folder),
    }


def wrong_points(metadata: Path, rubric: Rubric) -> str:
    """
    Return in words that an assignment has less points than its rubric gives; nothing if not.

    :param metadata: submission_metadata.json; see .../submission_metadata/ there.
    """
    try:
        total = float(
            json.loads(metadata.read_text(encoding='utf-8'))['assignment']['total_points']
        )
    except (OSError, ValueError, KeyError, TypeError):  # Gradescope says it may change
        return ''
    if total >= rubric.points:
        return ''
    return (
        f'the assignment has {total:g} points on Gradescope, and the rubric {rubric.points:g}: '
        f'set the points of the autograder to {rubric.points:g} there'
    )


def _test(step: StepGrade) -> dict[str, Any]:
    said = [step.why]
    if step.printed and not step.is_full:
        said += ['', 'It printed:', step.printed.rstrip()]
    return {
        'name': step.name,
        'score': round(step.points, 3),
        'max_score': step.most,
        'status': 'passed' if step.is_full else 'failed',
        'output': printable('\n'.join(said), keep='\n\t'),
        'visibility': 'visible',
    }


def _leaderboard(rubric: Rubric, folder: Path) -> list[dict[str, Any]]:
    """Return time and tracking error of the drives that students may see, if all arrived."""
    drives = list(_reports(rubric, folder))
    if not drives or not all(drive.get('completed') for drive in drives):
        return []
    time_sec = sum(drive['sim_time_sec'] for drive in drives)
    error_m = max(drive['cross_track_rms_m'] for drive in drives)
    return [
        {'name': 'time', 'value': round(time_sec, 2), 'order': 'asc'},
        {'name': 'tracking error', 'value': round(error_m, 3), 'order': 'asc'},
    ]


def _reports(rubric: Rubric, folder: Path) -> list[Mapping[str, Any]]:
    """Return the reports of the courses that are not hidden; of a drive without one, nothing."""
    places: list[Path] = []
    for step in rubric.steps:
        if isinstance(step, DriveStep):
            found = drive_folders(step, folder)
            places += [place for course, place in found if not course.hidden]
        elif isinstance(step, PathStep):
            places.append(folder / step.file_name)
    files = [place / REPORT_FILE for place in places]
    return [json.loads(file.read_text()) if file.is_file() else {} for file in files]
