# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whole gradings, with the simulator's physics in this process."""

import json
from pathlib import Path
from shutil import copy
import subprocess
import sys
from typing import Any

from husky_course.record import COURSE_NAME, read_record, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.check import main as check
from husky_grader.grade import main as grade
from husky_grader.report.folder import alone_in
from husky_grader.run.in_process import drive_route
from husky_grader.scoring.report import judge
from husky_sim.world import default_worlds
import pytest

THROUGH = 'speed: 0.6\nwaypoints:\n  - [0, 0]\n  - [4.5, 0]\n'
KEYS = (
    *(
        'passed',
        'completed',
        'ended_early',
        'disturbances',
        'waypoints_reached',
        'waypoints_total',
        'collisions',
        'cross_track_rms_m',
    ),
    *('cross_track_max_m', 'min_clearance_m', 'path_length_m', 'driven_m', 'sim_time_sec'),
    *('wall_time_sec', 'trajectory_sha256', 'score'),
)


def graded(file: Path, folder: Path, *arguments: str) -> tuple[int, dict[str, Any]]:
    code = grade([str(file), '--report', str(folder), *arguments])
    return code, json.loads((folder / 'report.json').read_text())


def test_the_central_barrier_is_passed_within_the_lab_limits(
    courses: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, report = graded(courses / 'central_barrier.yaml', tmp_path)
    assert code == 0
    assert set(KEYS) <= set(report)
    assert report['completed']
    assert report['waypoints_reached'] == report['waypoints_total'] == 13
    assert report['collisions'] == []
    assert report['cross_track_rms_m'] <= 0.03
    assert report['cross_track_max_m'] <= 0.08
    assert report['path_length_m'] / report['sim_time_sec'] >= 0.88 * 0.8
    assert report['score'] == pytest.approx(100.0)
    printed = capsys.readouterr().out
    assert 'central_barrier: passed, score 100.0 of 100' in printed
    page = (tmp_path / 'report.html').read_text()
    assert 'http' not in page.replace('http://www.w3.org', '')
    assert (tmp_path / 'path.png').read_bytes().startswith(b'\x89PNG')


def test_a_closed_pipe_ends_grade_without_a_message(courses: Path, tmp_path: Path) -> None:
    course = str(courses / 'straight.yaml')
    command = [sys.executable, '-m', 'husky_grader.grade', course, '--report', str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        run.stdout.close()
        assert run.stderr.read() == b''
    assert run.returncode == 141
    assert (tmp_path / 'report.html').exists()


def test_a_folder_in_which_another_writes_is_refused(courses: Path, tmp_path: Path) -> None:
    words = ['husky_grader.grade', str(courses / 'straight.yaml'), '--report', 'there/..']
    with alone_in(tmp_path), alone_in(tmp_path):
        refused = run_module(*words, cwd=tmp_path)
    assert (refused.returncode, refused.stdout) == (2, '')
    assert refused.stderr == (
        'there/..: another drive or grading writes its report there; wait for its end, or name '
        'another folder with --report DIR\n'
    )
    (tmp_path / 'circle').symlink_to('circle')
    with alone_in(tmp_path), alone_in(tmp_path / 'circle'):
        pass


def test_a_file_in_place_of_the_folder_is_refused(
    courses: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / 'report').touch()
    monkeypatch.chdir(tmp_path)
    assert grade([str(courses / 'straight.yaml')]) == 2
    expected = 'report: a file, no folder; name another with --report DIR\n'
    assert capsys.readouterr().err == expected


def test_what_cannot_be_printed_is_one_line(courses: Path, tmp_path: Path) -> None:
    with Path('/dev/full').open('w') as full:
        checked = run_module(
            'husky_grader.check', str(courses / 'straight.yaml'), cwd=tmp_path, stdout=full
        )
    assert (checked.returncode, checked.stderr) == (2, 'check: No space left on device\n')


@pytest.mark.parametrize('program', ['check', 'grade'])
def test_what_cannot_be_printed_nor_said_is_no_failed_course(
    courses: Path, tmp_path: Path, program: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of `> log 2>&1` on a full disk."""
    monkeypatch.delenv('PYTHONUNBUFFERED', raising=False)  # nothing is to be left for the end
    with Path('/dev/full').open('w') as full:
        course = str(courses / 'straight.yaml')
        ended = run_module(
            f'husky_grader.{program}', course, cwd=tmp_path, stdout=full, stderr=full
        )
    assert ended.returncode == 2


@pytest.mark.parametrize('given', ['nan', 'inf', '-1'])
def test_a_time_on_the_clock_is_a_number_of_seconds(
    given: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        grade(['--record', 'run', '--waypoints', 'course.yaml', f'--wall-time={given}'])
    assert ended.value.code == 2
    assert f'--wall-time {given}: give a number of seconds' in capsys.readouterr().err


def run_module(
    module: str,
    *words: str,
    cwd: Path,
    stdout: Any = subprocess.PIPE,
    stderr: Any = subprocess.PIPE,
) -> 'subprocess.CompletedProcess[str]':
    return subprocess.run(
        [sys.executable, '-m', module, *words],
        cwd=cwd,
        stdout=stdout,
        stderr=stderr,
        text=True,
        timeout=60.0,
        check=False,
    )


@pytest.mark.parametrize(
    'name',
    ['figure_eight', 'grand_perimeter', 'slalom', 'square', 'straight', 'west_inner'],
)
def test_every_course_is_driven_on_its_path_without_a_touch(courses: Path, name: str) -> None:
    route = plan_route(load_course(courses / f'{name}.yaml'))
    record, drive = drive_route(route)
    report = judge(read_run(record), route)
    assert report.passed, report.reasons
    assert drive.reached == drive.total == report.waypoints_reached
    assert report.cross_track_rms_m <= 0.04
    assert report.cross_track_max_m <= 0.15
    assert report.path_length_m / report.sim_time_sec >= 0.88 * route.course.speed_m_s


def test_on_ground_truth_the_deviation_is_below_three_cm(
    courses: Path,
) -> None:
    route = plan_route(load_course(courses / 'central_barrier.yaml'))
    record, _ = drive_route(route, odometry='ground_truth')
    assert judge(read_run(record), route).cross_track_rms_m <= 0.03


def test_a_start_elsewhere_takes_the_course_along(courses: Path) -> None:
    route = plan_route(load_course(courses / 'straight.yaml'))
    for odometry in ('filtered', 'wheel', 'ground_truth'):
        record, _ = drive_route(route, start=(-5.0, 2.0, 1.0), odometry=odometry)
        assert judge(read_run(record), route).passed


def test_the_way_to_a_first_waypoint_elsewhere_costs_no_points(tmp_path: Path) -> None:
    (tmp_path / 'away.yaml').write_text('waypoints: [[-3, 0], [-4, 0]]\n')
    assert grade([str(tmp_path / 'away.yaml'), '--report', str(tmp_path)]) == 0
    report = json.loads((tmp_path / 'report.json').read_text())
    assert report['score'] == 100.0, report['parts']


def test_a_course_through_the_barrier_fails_with_the_collision(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    course = tmp_path / 'through.yaml'
    course.write_text(THROUGH)
    code, report = graded(course, tmp_path / 'report', '--json')
    assert code == 1
    assert not report['completed']
    (touch,) = report['collisions']
    assert touch['obstacle'] == 'jersey_barrier_15'
    assert touch['force_n'] > 100.0
    assert report['min_clearance_m'] == 0.0
    assert report['reasons'][-1].startswith('gave up: the wheels drive 0.')
    assert json.loads(capsys.readouterr().out) == report


@pytest.mark.parametrize(
    ('arguments', 'expected'),
    [
        (
            [],
            'give waypoint files, --record FILE, --controller COMMAND, --lab SUBMISSION or --make',
        ),
        (
            ['--controller', 'ros2', 'run', 'my_driver', 'x', '--waypoints', 'a.yaml'],
            'put the command in quotes, as --controller "ros2 run my_driver x"',
        ),
        (['--controller', 'ros2 run a b', 'a.yaml'], 'one course: name that by --waypoints FILE'),
        (['--rubric', 'rubric.yaml', 'a.yaml'], '--rubric needs --lab SUBMISSION'),
        (
            ['--lab', '.', '--world', '/w.xml'],
            '--world /w.xml: write it into the rubric, as `world: FILE`',
        ),
        (['--lab', '.', '--interface', 'clearpath'], '--interface clearpath is for a controller'),
        (['--lab', '.', '--answers', '1'], '--lab takes courses and answers from the rubric'),
        (['--record', 'x.record'], '--record needs --waypoints FILE'),
        (['missing.yaml'], 'missing.yaml: no such file'),
        ([''], 'argument FILE: the name is empty'),
        (['--lab', '.', '--rubric', ''], 'argument --rubric: the name is empty'),
        (['--lab', '.', '--gradebook', ''], 'argument --gradebook: the name is empty'),
        (
            ['{empty}'],
            'no waypoint file lies in this folder (*.yaml); what was handed in for a lab',
        ),
        (['{course}', '--world', 'no.xml'], 'no.xml'),
        (['--record', 'no.record', '--waypoints', '{course}'], 'no.record: cannot be read'),
        (['--record', '{course}', '--waypoints', '{course}'], 'not the record of a run'),
    ],
)
def test_bad_input_is_refused_with_one_line(
    courses: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    expected: str,
) -> None:
    course = str(courses / 'straight.yaml')
    (tmp_path / 'empty').mkdir()
    places = {'{course}': course, '{empty}': str(tmp_path / 'empty')}
    arguments = [places.get(argument, argument) for argument in arguments]
    try:
        code = grade([*arguments, '--report', str(tmp_path)])
    except SystemExit as stopped:
        code = int(stopped.code or 0)
    printed = capsys.readouterr().err
    assert code == 2
    assert expected in printed
    assert len(printed.splitlines()) == 1


def test_a_folder_stands_for_its_waypoint_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ('b.yml', 'a.yaml', 'C.YAML', 'notes.txt', '._a.yaml', 'D.yaml.txt'):
        (tmp_path / name).write_text('waypoints: []\n')
    assert grade([str(tmp_path), '--jobs', '1', '--report', str(tmp_path / 'report')]) == 1
    printed = capsys.readouterr()
    assert [line.split()[0] for line in printed.out.splitlines()[:-1]] == ['C', 'a', 'b']
    told = f'{tmp_path}: take .txt off the names of D.yaml.txt, which are passed over'
    assert printed.err.splitlines()[0] == told


def test_what_lies_in_folders_of_a_folder_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = tmp_path / 'report'
    for name in ('anna', 'ben', '.git', 'pictures'):
        (tmp_path / name).mkdir()
    for name in ('anna/path.yaml', 'ben/path.yaml', '.git/a.yaml', 'pictures/a.png'):
        (tmp_path / name).write_text('waypoints: []\n')
    words = f'what lies in its folders (anna, ben) is graded by {tmp_path}/*/'
    assert grade([str(tmp_path), '--report', str(report)]) == 2
    assert capsys.readouterr().err.endswith(f'graded by --lab {tmp_path}; {words}\n')
    (tmp_path / 'carla.yaml').write_text('waypoints: []\n')
    grade([str(tmp_path), '--report', str(report)])
    assert capsys.readouterr().err.splitlines()[0] == f'{tmp_path}: {words}'
    folders = [str(tmp_path / name) for name in ('anna', 'ben')]
    grade([*folders, '--jobs', '1', '--report', str(report)])
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[:-1]] == ['anna_path', 'ben_path']


def test_a_check_names_the_waypoint_and_what_it_passes_too_near(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    course = tmp_path / 'through.yaml'
    course.write_text(THROUGH)
    assert check([str(course)]) == 2
    assert check(['--warn', str(course)]) == 0
    printed = capsys.readouterr()
    warned = printed.err.splitlines()[0]
    assert 'through.yaml: line 4: on the way to waypoint 2 the robot touches' in warned
    assert 'jersey_barrier_15' in warned
    assert f'{course}: goes through jersey_barrier_15: 2 waypoints' in printed.out
    course.write_text('waypoints: [[0.0, 0.0], [0.95, 0.0]]\n')
    assert check([str(course)]) == 0
    assert check(['--refuse', str(course)]) == 1
    warned = capsys.readouterr().err.splitlines()[0]
    assert 'jersey_barrier_15 near' in warned
    assert warned.endswith('; keep 0.15 m from its bumpers and wheels')


def test_a_check_looks_at_the_way_to_the_first_waypoint(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    course = tmp_path / 'beyond.yaml'  # of the barrier in front of the robot
    course.write_text('waypoints: [[4.5, 0.0], [5.0, 0.0]]\n')
    assert check([str(course)]) == 2
    assert 'on the way to waypoint 1 the robot touches' in capsys.readouterr().err


def test_a_check_counts_the_waypoints_as_the_report_does(
    courses: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    course = load_course(courses / 'central_barrier.yaml')
    assert check([course.file]) == 0
    said = f'{len(course.stops)} waypoints (the last is the first again), '
    assert said in capsys.readouterr().out


def test_escape_codes_in_names_do_not_reach_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    course = tmp_path / 'a\x1b[2J\u202e.yaml'
    course.write_text('speed: 0.8\nwaypoints: [[0, 0], [-1, 0]]\n')
    broken = tmp_path / 'b\x1b]0;title\x07.yaml'
    broken.write_text('speed: fast\n')
    assert check([str(course)]) == 0
    assert grade([str(course), '--report', str(tmp_path / 'r\x1b[31m')]) == 0
    assert grade([str(broken), '--report', str(tmp_path / 'report')]) == 2
    with pytest.raises(SystemExit):
        grade([str(course), '--\x1b[31m\n.yaml'])  # what a shell makes of *.yaml
    said = capsys.readouterr()
    assert {char for char in said.out + said.err if not char.isprintable()} == {'\n'}
    assert r'a\x1b[2J\u202e: passed' in said.out
    assert r'b\x1b]0;title\x07.yaml: line 1' in said.err


def test_a_report_that_cannot_be_written_is_one_line(
    courses: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'report').touch()
    course = str(courses / 'straight.yaml')
    assert grade([course, '--report', str(tmp_path / 'report' / 'deep')]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f'{tmp_path / "report" / "deep"}: Not a directory'


def test_a_course_of_a_person_stays_where_the_report_lies(courses: Path, tmp_path: Path) -> None:
    own = tmp_path / 'waypoints.yaml'
    own.write_text('waypoints: [[0, 0], [9, 9]]')
    assert graded(courses / 'straight.yaml', tmp_path)[0] == 0
    assert own.read_text() == 'waypoints: [[0, 0], [9, 9]]'


def test_a_graded_run_can_be_replayed(courses: Path, tmp_path: Path) -> None:
    course = courses / 'straight.yaml'
    code, first = graded(course, tmp_path)
    assert code == 0
    assert read_record(tmp_path).complete
    kept = tmp_path / COURSE_NAME
    assert kept.read_bytes() == course.read_bytes()
    # And what was kept can be graded into its own folder.
    code, second = graded(kept, tmp_path)
    assert code == 0
    assert kept.read_bytes() == course.read_bytes()
    # The same file gives the same trajectory.
    assert first['trajectory_sha256'] == second['trajectory_sha256']
    assert first['score'] == second['score']


def test_a_record_names_the_world_as_it_is_from_every_folder(
    courses: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = Path(copy(default_worlds() / 'empty.xml', tmp_path / 'my_world.xml'))
    course, report = courses.absolute() / 'straight.yaml', tmp_path / 'report'
    monkeypatch.chdir(tmp_path)
    assert grade([str(course), '--world', world.name, '--report', str(report)]) == 0
    assert read_record(report).world == str(world)


@pytest.mark.parametrize(('name', 'magic'), [('a.png', b'\x89PNG'), ('a.svg', b'<?xml')])
def test_a_check_draws_the_course(courses: Path, tmp_path: Path, name: str, magic: bytes) -> None:
    assert check([str(courses / 'straight.yaml'), '--draw', str(tmp_path / name)]) == 0
    assert (tmp_path / name).read_bytes().startswith(magic)
