# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A clone that its users may only read, as one that is there for all of a computer."""

from pathlib import Path
import re
import shutil

from playpen_testing.processes import Process, Processes
import pytest

ROOT = Path(__file__).resolve().parent.parent
# Shown to these processes alone, and not to be written, not even by root.
READ_ONLY = 'mount --bind "$0" "$0" && mount -o remount,ro,bind "$0" && exec "$@"'
# A root that other users' files are as closed to as to anybody.
READER = ('unshare', '--user', '--map-root-user')


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    folder = tmp_path / 'clone'
    for name in ('requirements', 'underlay'):
        shutil.copytree(ROOT / name, folder / name)
    shutil.copy(ROOT / 'lab', folder)
    return folder


def start_reading(processes: Processes, clone: Path, *words: str) -> Process:
    mounted = ('unshare', '--mount', 'bash', '-c', READ_ONLY, str(clone))
    return processes.start(*mounted, str(clone / 'lab'), *words)


def test_a_student_drives_and_grades(processes: Processes, short_course: Path, home: Path) -> None:
    drive = ('drive', str(short_course), '--fast', '--no-view')
    drives = start_reading(processes, ROOT, *drive)
    assert drives.wait(timeout_sec=60.0) == 0, drives.output
    assert (home / 'report' / 'report.html').is_file()
    grades = start_reading(processes, ROOT, 'grade', str(short_course), '--report', 'graded')
    assert grades.wait(timeout_sec=60.0) == 0, grades.output


@pytest.mark.usefixtures('home')
def test_a_student_builds_a_package_and_runs_it(processes: Processes) -> None:
    steps = (
        'ros2 pkg create small --build-type ament_python --node-name hello',
        'colcon build',
        'source install/setup.bash',
        'ros2 run small hello',
    )
    built = start_reading(processes, ROOT, 'exec', 'bash', '-c', ' && '.join(steps))
    assert built.wait(timeout_sec=60.0) == 0, built.output
    assert 'Hi from small.' in built.lines


def test_what_it_lacks_is_left_to_its_owner(processes: Processes, clone: Path) -> None:
    refused = start_reading(processes, clone, 'exec', 'true')
    assert refused.wait() == 2, refused.output
    (line,) = refused.lines
    assert line.startswith(f'lab: cannot write in {clone}, and it is not set up for this (ROS: ')
    assert f"let its owner call '{clone}/lab exec true', or clone the lab" in line


def test_the_owner_is_told_of_a_python_that_others_can_run(
    processes: Processes, clone: Path
) -> None:
    """Without it the owner's call would find all set up, by a Python of his own."""
    (clone / '.venv').mkdir()
    of_its_owner = f'{clone}/.venv /home/owner/python3'
    made_for = ''.join(f'{ros} {of_its_owner}\n' for ros in ('pip', 'sourced'))
    (clone / '.venv' / '.made-for').write_text(made_for)
    refused = start_reading(processes, clone, 'exec', 'true')
    assert refused.wait() == 2, refused.output
    (line,) = refused.lines
    found = re.search(r"Python 3[.]\d+[.]\d+: (.*)\): let its owner call '(.*)', or", line)
    assert found, line
    assert found[2] == f'PYTHON={found[1]} {clone}/lab exec true', line


def test_the_owner_is_told_of_what_sudo_has_made(processes: Processes, clone: Path) -> None:
    (clone / '.venv').mkdir()
    shutil.chown(clone / '.venv', 12345)
    refused = processes.start(*READER, str(clone / 'lab'), 'exec', 'true')
    assert refused.wait() == 2, refused.output
    (line,) = refused.lines
    assert line.startswith(f'lab: {clone}/.venv is not yours, as after sudo, and it is not set up')
    assert f"call 'sudo chown -R 0 {clone}', then ./lab again, without sudo." in line


def test_a_set_up_that_its_owner_alone_may_read_is_named(
    processes: Processes, clone: Path
) -> None:
    for made in (clone / '.venv', clone / '.lab.lock'):
        made.mkdir(mode=0o700)
        shutil.chown(made, 12345)
    refused = processes.start(*READER, str(clone / 'lab'), 'exec', 'true')
    assert refused.wait() == 2, refused.output
    (line,) = refused.lines
    assert line.startswith(f'lab: {clone}/.venv may not be read: let its owner call')
    assert f"'chmod -R go+rX {clone}', or clone the lab into" in line
