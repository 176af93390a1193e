# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""results.json of Gradescope and result.json of Classroom 50, against what both document."""

from datetime import datetime, timezone
import json
from pathlib import Path

from husky_grader.autograder.classroom50 import classroom_result
from husky_grader.autograder.gradescope import gradescope_results, wrong_points
from husky_grader.graded import Graded, StepGrade
from husky_grader.rubric.steps import CourseToDrive, DriveStep, Rubric
from husky_grader.submission import Submission
from playpen_testing.autograder_shapes import check_classroom50, check_gradescope
import pytest

RUNNER = {
    'CLASSROOM': 'robotics',
    'ASSIGNMENT': 'lab-2',
    'ASSIGNMENT_TYPE': 'group',
    'OWNER': 'octocat',
    'SUBMISSION_TAG': 'submit/2026-11-22T20-00-00Z-a1b2c3d',
    'COMMIT_URL': 'https://github.com/robotics/robotics-lab-2-octocat/commit/a1b2c3d',
    'RELEASE_URL': 'https://github.com/robotics/robotics-lab-2-octocat/releases/tag/submit',
}
NOON = datetime(2026, 11, 22, 12, tzinfo=timezone.utc)
SUBMISSION = Submission('alice', Path('alice'), 'folder')
RUBRIC = Rubric(
    title='Driving',
    steps=(
        DriveStep(
            points=30.0,
            name='drive',
            package='my_driver',
            executable='follow_path',
            courses=(
                CourseToDrive(file=Path('open.yaml')),
                CourseToDrive(file=Path('closed.yaml'), title='course B', hidden=True),
            ),
        ),
    ),
)


def graded(*steps: StepGrade, refused: str = '') -> Graded:
    most = sum(step.most for step in steps) or 30.0
    return Graded(SUBMISSION, most, steps, refused, sandbox='user', notes=['left out: build'])


def write_drive(folder: Path, *, completed: bool) -> None:
    folder.mkdir(parents=True)
    report = {'completed': completed, 'sim_time_sec': 25.4567, 'cross_track_rms_m': 0.03951}
    (folder / 'report.json').write_text(json.dumps(report))


def test_each_step_is_a_test_and_nothing_is_html(tmp_path: Path) -> None:
    steps = (
        StepGrade('build', 15.0, 15.0, 'colcon build succeeded', 'Starting'),
        StepGrade('drive', 30.0, 7.1234, 'touched a wall', 'line\n<script>\x1b[31m</script>'),
    )
    results = gradescope_results(graded(*steps), RUBRIC, tmp_path, took_sec=12.4)
    check_gradescope(results)
    assert results['score'] == 22.123
    build, drive = results['tests']
    assert build['output'] == 'colcon build succeeded'
    assert (drive['score'], drive['max_score'], drive['status']) == (7.123, 30.0, 'failed')
    assert drive['output'].endswith('It printed:\nline\n<script>\\x1b[31m</script>')
    assert results['output'] == 'Built and run in the sandbox "user".\nleft out: build'
    assert results['leaderboard'] == []


def test_the_leaderboard_has_drives_that_arrived(tmp_path: Path) -> None:
    write_drive(tmp_path / 'drive_1', completed=True)
    results = gradescope_results(graded(), RUBRIC, tmp_path, took_sec=1.0)
    check_gradescope(results)
    assert results['leaderboard'] == [
        {'name': 'time', 'value': 25.46, 'order': 'asc'},
        {'name': 'tracking error', 'value': 0.04, 'order': 'asc'},
    ]


def test_the_leaderboard_has_nothing_of_hidden_courses(tmp_path: Path) -> None:
    write_drive(tmp_path / 'staff' / 'drive_2', completed=True)
    write_drive(tmp_path / 'drive_1', completed=False)
    results = gradescope_results(graded(), RUBRIC, tmp_path, took_sec=1.0)
    assert results['leaderboard'] == []


def test_a_refused_submission_is_told_why(tmp_path: Path) -> None:
    refused = graded(refused='alice: no package in it')
    results = gradescope_results(refused, RUBRIC, tmp_path, took_sec=1.0)
    check_gradescope(results)
    assert (results['score'], results['tests']) == (0, [])
    assert results['output'].splitlines()[0] == 'Not graded: alice: no package in it'


def test_an_assignment_with_too_few_points_is_noticed(tmp_path: Path) -> None:
    metadata = tmp_path / 'submission_metadata.json'
    assert wrong_points(metadata, RUBRIC) == ''
    metadata.write_text('{"id": 123456, "assignment": {"id": 25828, "total_points": "20.0"}}')
    assert wrong_points(metadata, RUBRIC).startswith('the assignment has 20 points on Gradescope')
    metadata.write_text('{"id": 123456, "assignment": {"id": 25828, "total_points": "40.0"}}')
    assert wrong_points(metadata, RUBRIC) == ''


def test_points_of_classroom_50_are_rounded_down() -> None:
    steps = (
        StepGrade('build', 15.0, 15.0, 'colcon build succeeded'),
        StepGrade('drive', 30.0, 29.96, 'off the path'),
        StepGrade('name', 2.5, 2.5, 'right'),
        StepGrade('tenths', 3.0, 0.1 + 0.2 + 1.7, 'right in part'),
        StepGrade('bonus', 0.0, 0.0, 'none'),
    )
    result = classroom_result(graded(*steps), RUNNER, NOON)
    check_classroom50(result)
    assert [(test['score'], test['passed']) for test in result['tests']] == [
        *((15, True), (29, False), (3, True), (2, False), (0, True))
    ]
    assert (result['score'], result['max-score']) == (49, 51)
    assert result['tests'][1]['points'] == 29.96
    assert result['review'] == RUNNER['COMMIT_URL']
    assert result['datetime'] == '2026-11-22T12:00:00Z'


def test_a_refused_submission_has_no_points_in_classroom_50() -> None:
    result = classroom_result(graded(refused='no package in it'), RUNNER, NOON)
    check_classroom50(result)
    assert (result['score'], result['max-score']) == (0, 30)
    assert result['tests'][0]['why'] == 'no package in it'


def test_a_result_without_the_runner_of_classroom_50_is_refused() -> None:
    with pytest.raises(ValueError, match='OWNER, RELEASE_URL: not set'):
        classroom_result(graded(), {**RUNNER, 'OWNER': '', 'RELEASE_URL': ''})
