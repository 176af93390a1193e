# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The command rosdep, as the tutorials call it."""

from __future__ import annotations

from pathlib import Path
import subprocess

import pytest

AS_IN_TUTORIALS = 'rosdep install -i --from-path src --rosdistro jazzy -y'


def run(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(command.split(), cwd=folder, capture_output=True, text=True)
    assert 'Traceback' not in done.stderr, done.stderr
    return done


def hand_in(workspace: Path, name: str, *depends: str) -> None:
    folder = workspace / 'src' / name
    folder.mkdir(parents=True)
    tags = ''.join(f'<{tag}>{key}</{tag}>' for tag, key in (each.split() for each in depends))
    (folder / 'package.xml').write_text(
        f'<package format="3"><name>{name}</name><version>0.0.1</version>'
        '<description>d</description><maintainer email="a@b.org">a</maintainer>'
        f'<license>Apache-2.0</license>{tags}</package>'
    )


@pytest.mark.parametrize(
    'command', [AS_IN_TUTORIALS, 'rosdep install --from-paths src --ignore-src -r -y']
)
def test_what_the_tutorials_need_is_here(tmp_path: Path, command: str) -> None:
    hand_in(tmp_path, 'py_pubsub', 'exec_depend rclpy', 'depend std_msgs', 'depend my_interfaces')
    hand_in(
        tmp_path,
        'my_interfaces',
        'buildtool_depend ament_cmake',
        'build_depend rosidl_default_generators',
        'exec_depend rosidl_default_runtime',
        *('test_depend ament_copyright', 'test_depend python3-pytest'),
        *('exec_depend python3-numpy', 'exec_depend python3-yaml', 'exec_depend tf2_ros_py'),
    )
    done = run(command, tmp_path)
    expected = (0, '#All required rosdeps installed successfully\n', '')
    assert (done.returncode, done.stdout, done.stderr) == expected


def test_what_is_missing_is_told_with_what_helps(tmp_path: Path) -> None:
    hand_in(
        tmp_path,
        'mine',
        *('exec_depend rviz2', 'exec_depend python3-no-such', 'build_depend moveit_core'),
        'exec_depend skipped',
    )
    done = run(f'{AS_IN_TUTORIALS} --skip-keys skipped', tmp_path)
    assert (done.returncode, done.stdout) == (1, '')
    moveit, pip, rviz = done.stderr.splitlines()
    assert moveit == (
        'rosdep: mine needs moveit_core, which is not here; a package with C++ in it needs a '
        'sourced ROS 2 Jazzy'
    )
    assert pip.endswith('python3-no-such, which is not here; `pip install no-such` may bring it')
    assert rviz.startswith('rosdep: mine needs rviz2, which is not here: it has no wheel; here')


@pytest.mark.parametrize(
    ('key', 'name'),
    [
        ('python3-serial', 'pyserial'),
        ('python3-sklearn', 'scikit-learn'),
        ('python3-no.such', 'no.such'),
    ],
)
def test_pip_is_asked_for_its_own_names(tmp_path: Path, key: str, name: str) -> None:
    hand_in(tmp_path, 'mine', f'exec_depend {key}')
    done = run(AS_IN_TUTORIALS, tmp_path)
    told = f'rosdep: mine needs {key}, which is not here; `pip install {name}` may bring it\n'
    assert (done.returncode, done.stderr) == (1, told)


def test_init_and_update_have_nothing_to_do(tmp_path: Path) -> None:
    for command in ('rosdep init', 'rosdep update --rosdistro jazzy'):
        done = run(command, tmp_path)
        assert (done.returncode, done.stderr) == (0, '')
        assert done.stdout == 'nothing to do: the packages of this installation are wheels\n'


@pytest.mark.parametrize(
    ('command', 'why'),
    [
        ('rosdep install', 'name packages, or folders of packages: --from-paths src'),
        ('rosdep install --from-paths nowhere', "given path 'nowhere' does not exist"),
        ('rosdep install --from-paths src', 'bad'),
        ('rosdep where-defined rclpy', "invalid choice: 'where-defined'"),
    ],
)
def test_a_bad_call_is_refused(tmp_path: Path, command: str, why: str) -> None:
    (tmp_path / 'src' / 'bad').mkdir(parents=True)
    (tmp_path / 'src' / 'bad' / 'package.xml').write_text('<package')
    done = run(command, tmp_path)
    assert done.returncode == 2
    assert why in done.stderr.splitlines()[-1]


def test_a_package_is_named_by_itself(tmp_path: Path) -> None:
    assert run('rosdep check husky_sim', tmp_path).returncode == 0
    done = run('rosdep check moveit_ros', tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith('rosdep: moveit_ros is not here; ')
