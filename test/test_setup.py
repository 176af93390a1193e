# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `./lab` says when it cannot set up: one line, exit status 2, nothing broken."""

import os
from pathlib import Path
import shutil
import subprocess

import pytest

ROOT = Path(__file__).resolve().parent.parent
NOBODY = 'http://127.0.0.1:9/simple'  # an index of packages that does not answer


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """Return a folder with what the set-up reads of a fresh clone, and nothing set up."""
    folder = tmp_path / 'clone'
    (folder / 'underlay').mkdir(parents=True)
    shutil.copy(ROOT / 'lab', folder)
    shutil.copytree(ROOT / 'requirements', folder / 'requirements')
    no_modules = shutil.ignore_patterns('src', 'test')
    shutil.copytree(ROOT / 'underlay', folder / 'underlay', ignore=no_modules, dirs_exist_ok=True)
    child_of_lab = Path('src', 'husky_runtime', 'husky_runtime', 'parent_death.py')
    (folder / child_of_lab).parent.mkdir(parents=True)
    shutil.copy(ROOT / child_of_lab, folder / child_of_lab)
    return folder


def plain_environment() -> dict[str, str]:
    """Return the environment of a terminal in which nothing of ROS or the lab is set up."""
    ours = ('ROS_', 'AMENT_', 'COLCON_', 'HUSKY_', '_ROS_', 'VIRTUAL_ENV', 'LD_LIBRARY', 'PYTHON')
    kept = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    venv = os.environ.get('VIRTUAL_ENV', '')
    folders = kept['PATH'].split(os.pathsep)
    kept['PATH'] = os.pathsep.join(
        folder for folder in folders if not (venv and folder.startswith(venv))
    )
    return kept


def lab(clone: Path, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(clone / 'lab'), *words],
        cwd='/',
        env={**plain_environment(), **environment},
        capture_output=True,
        text=True,
        timeout=60,
    )


def program(folder: Path, name: str, text: str) -> str:
    """Put a program into a folder and return a PATH on which it comes first."""
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(f'#!/bin/sh\n{text}\n')
    (folder / name).chmod(0o755)
    return f'{folder}{os.pathsep}{plain_environment()["PATH"]}'


def refused(done: subprocess.CompletedProcess[str], *words: str) -> None:
    """Hold that the last line printed says why and that the exit status is 2."""
    lines = done.stderr.splitlines()
    assert done.returncode == 2, done.stderr
    assert lines[-1].startswith('lab: ')
    assert [word for word in words if word not in lines[-1]] == [], done.stderr
    assert len(lines) <= 2, 'at most one line of progress and one of refusal'


def test_another_ros_than_jazzy_is_refused(clone: Path) -> None:
    done = lab(clone, 'exec', 'true', ROS_DISTRO='humble', AMENT_PREFIX_PATH='/opt/ros/humble')
    refused(done, 'humble', 'ROS 2 Jazzy', 'source')


def test_an_old_python_is_refused(clone: Path, tmp_path: Path) -> None:
    program(tmp_path / 'bin', 'old', '[ "$1" = --version ] && echo Python 3.8.18 || echo 308')
    done = lab(clone, 'exec', 'true', PYTHON=str(tmp_path / 'bin' / 'old'))
    refused(done, 'Python 3.8.18', '3.10', 'PYTHON=')


@pytest.mark.parametrize('has_rclpy', [True, False])
def test_a_sourced_ros_gets_the_python_that_has_rclpy(
    clone: Path, tmp_path: Path, *, has_rclpy: bool
) -> None:
    path = program(tmp_path / 'bin', 'python3', 'exit 1')  # of another version, say
    (tmp_path / 'rclpy.py').write_text('' if has_rclpy else 'raise ImportError')
    sourced = {'ROS_DISTRO': 'jazzy', 'AMENT_PREFIX_PATH': '/opt/ros/jazzy', 'PATH': path}
    offline = {'PIP_INDEX_URL': NOBODY, 'PIP_CONFIG_FILE': os.devnull}
    done = lab(clone, 'exec', 'true', PYTHONPATH=str(tmp_path), **sourced, **offline)
    if has_rclpy:
        refused(done, 'no network')
    else:
        refused(done, 'no Python on PATH can import rclpy', 'PYTHON=')


@pytest.mark.parametrize(
    ('ros', 'range_before', 'range_now'),
    [
        ('pip', '', 'LOCALHOST'),
        ('pip', 'SUBNET', 'SUBNET'),
        ('sourced', 'SUBNET', 'LOCALHOST'),
        ('sourced', 'SYSTEM_DEFAULT', 'SYSTEM_DEFAULT'),
    ],
)
def test_only_a_range_of_the_users_own_goes_beyond_this_machine(
    ros: str, range_before: str, range_now: str
) -> None:
    told = {'HUSKY_LAB_ROS': ros, 'ROS_AUTOMATIC_DISCOVERY_RANGE': range_before}
    script = 'source "$0" help >/dev/null; choose_range; echo "$ROS_AUTOMATIC_DISCOVERY_RANGE"'
    done = subprocess.run(
        ['bash', '-c', script, ROOT / 'lab'],
        env={**plain_environment(), **told},
        capture_output=True,
        text=True,
    )
    assert done.stdout.strip() == range_now, done.stderr


def test_a_platform_without_wheels_is_told_what_to_do(clone: Path, tmp_path: Path) -> None:
    path = program(tmp_path / 'bin', 'uname', '[ "$1" = -s ] && echo Darwin || echo arm64')
    refused(lab(clone, 'exec', 'true', PATH=path), 'Darwin arm64', 'RoboStack', 'source')


def test_a_full_disk_is_said_before_anything_is_made(clone: Path, tmp_path: Path) -> None:
    path = program(tmp_path / 'bin', 'df', 'printf "h\\nfs 1 1 90000 1%% /\\n"')
    refused(lab(clone, 'exec', 'true', PATH=path), 'disk is full', '87 MB', 'free some space')
    assert not (clone / '.venv').exists()


def test_no_network_is_said_also_after_an_interrupted_set_up(clone: Path) -> None:
    (clone / '.venv' / 'bin').mkdir(parents=True)
    (clone / '.venv' / 'bin' / 'python').symlink_to('/nonexistent/python')
    done = lab(clone, 'exec', 'true', PIP_INDEX_URL=NOBODY, PIP_CONFIG_FILE=os.devnull)
    refused(done, 'no network', 'call ./lab again')


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['fly'], "unknown word 'fly'"),
        (['drive', '--quick'], "'--quick'"),
        (['drive', '--report'], '--report needs a value'),
        (['exec'], 'exec needs a command'),
    ],
)
def test_a_wrong_word_is_refused_before_anything_is_set_up(
    clone: Path, words: list[str], said: str
) -> None:
    refused(lab(clone, *words), said)
    assert not (clone / '.venv').exists()
