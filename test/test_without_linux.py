# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The lab without what only Linux has, taken from every Python that it starts."""

import json
import os
from pathlib import Path
import subprocess
import sys

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.run.in_process import drive_route
from playpen_testing import without_linux
import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture
def elsewhere(tmp_path: Path) -> dict[str, str]:
    """Return the environment of programs without Linux; each leaves its command in seen/."""
    (tmp_path / 'site').mkdir()
    (tmp_path / 'seen').mkdir()
    (tmp_path / 'site' / 'sitecustomize.py').symlink_to(without_linux.__file__)
    path = f'{tmp_path / "site"}{os.pathsep}{os.environ.get("PYTHONPATH", "")}'
    seen = {without_linux.SEEN_VARIABLE: str(tmp_path / 'seen')}
    others = {name: value for name, value in os.environ.items() if name != 'ROS_DOMAIN_ID'}
    return {**others, **seen, 'PYTHONPATH': path, 'TMPDIR': str(tmp_path)}


def run(environment: dict[str, str], *command: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=100.0, cwd=ROOT
    )


def python(environment: dict[str, str], program: str) -> str:
    done = run(environment, sys.executable, '-c', program)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_all_of_it_is_taken_away(elsewhere: dict[str, str]) -> None:
    said = python(
        elsewhere,
        'import ctypes, os, pathlib, sys\n'
        'print(sys.platform, hasattr(os, "sched_getaffinity"))\n'
        'print(pathlib.Path("/proc/self/maps").exists(), os.path.exists("/dev/shm"))\n'
        'print(hasattr(ctypes.CDLL(None), "prctl"), list(pathlib.Path("/proc").glob("*")))\n',
    )
    assert said.split('\n')[:3] == ['darwin False', 'False False', 'False []']


@pytest.mark.timeout(120)
def test_a_drive_is_the_same_and_all_of_it_ends(
    elsewhere: dict[str, str], short_course: Path, tmp_path: Path
) -> None:
    report = tmp_path / 'report'
    words = ('drive', short_course, '--fast', '--no-open', '--report', report)
    done = run(elsewhere, ROOT / 'lab', *words)
    assert done.returncode == 0, done.stdout + done.stderr
    assert 'Traceback' not in done.stderr
    told = json.loads((report / 'report.json').read_text())
    same = read_run(drive_route(plan_route(load_course(short_course)))[0])
    assert told['trajectory_sha256'] == same.trajectory_sha256
    seen = {int(file.name): file.read_text() for file in (tmp_path / 'seen').iterdir()}
    for program in ('drive', 'husky_sim', 'view', 'follow_path'):
        assert any(f'/{program}' in command for command in seen.values()), (program, seen)
    assert [number for number in seen if Path(f'/proc/{number}').exists()] == []


def test_a_class_is_graded_on_all_processors(
    elsewhere: dict[str, str], short_course: Path, tmp_path: Path
) -> None:
    (tmp_path / 'class').mkdir()
    for name in ('ada', 'grace'):
        (tmp_path / 'class' / f'{name}.yaml').write_text(short_course.read_text())
    report = tmp_path / 'grades'
    done = run(elsewhere, ROOT / 'lab', 'grade', tmp_path / 'class', '--report', report)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (report / 'grades.csv').read_text().count('100') >= 2


def test_two_simulators_in_a_domain_are_refused_by_a_file(elsewhere: dict[str, str]) -> None:
    said = python(
        elsewhere,
        'from husky_runtime.domains import DomainError, OwnDomain, lock_simulator\n'
        'with OwnDomain() as own:\n'
        '    held = lock_simulator(own.number)\n'
        '    try:\n'
        '        lock_simulator(own.number)\n'
        '    except DomainError as error:\n'
        '        print(error)\n'
        '    held.close()\n'
        '    lock_simulator(own.number).close()\n',
    )
    assert 'another simulator runs in ROS domain' in said
    assert ': a process of this machine; end it' in said


def test_the_camera_says_what_is_missing(elsewhere: dict[str, str]) -> None:
    said = python(
        elsewhere,
        'from husky_gym.environment import HuskyPlaypen\n'
        'env = HuskyPlaypen(render_mode="rgb_array", laser_beams=0)\n'
        'env.reset()\n'
        'try:\n'
        '    env.render()\n'
        'except RuntimeError as error:\n'
        '    print(error)\n',
    )
    assert 'no picture can be drawn here' in said
    assert 'set render_mode to None' in said
