# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 run` and `ros2 launch` say of a package that was built wrong, or ends too early."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import subprocess
import sys
from typing import Any

import pytest
from ros2_diagnosis import early_ends

_ENTRY = "'hello = mine.hello:main',"
_LAUNCH_FILES = "('share/mine/launch', glob('launch/*')),"
_NO_SPIN = """import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def main():
    rclpy.init()
    node = Node('hello')
    node.timer = node.create_timer(0.1, lambda: None)
    try:
        pass  # rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
"""
_TOO_SOON = """import rclpy
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('hello')
    node.create_publisher(String, 'chatter', 10).publish(String(data='once'))
"""


@pytest.fixture(scope='module')
def as_built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a workspace with the package `mine`, built once for all tests, under another name."""
    folder = tmp_path_factory.mktemp('workspaces') / 'workspace'
    source = folder / 'src'
    source.mkdir(parents=True)
    words = ('pkg', 'create', 'mine', '--build-type', 'ament_python', '--node-name', 'hello')
    create = [sys.executable, '-m', 'ros2cli', *words, '--license', 'MIT']
    subprocess.run(create, cwd=source, capture_output=True, check=True)
    (source / 'mine' / 'launch').mkdir()
    (source / 'mine' / 'launch' / 'hello.launch.py').touch()
    setup = source / 'mine' / 'setup.py'
    text = setup.read_text().replace('data_files=[', f'data_files=[{_LAUNCH_FILES}')
    setup.write_text(f'from glob import glob\n{text}')
    built = build(folder)
    assert (built.returncode, built.stderr) == (0, '')
    return folder.rename(folder.with_name('as_built'))


@pytest.fixture
def workspace(as_built: Path, domain: int, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a copy of it where it was built, where AMENT_PREFIX_PATH says it is sourced."""
    del domain  # it has a folder of logs
    folder = as_built.with_name('workspace')
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(as_built, folder, symlinks=True)
    prefixes = [str(folder / 'install' / 'mine'), os.environ['AMENT_PREFIX_PATH']]
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
    modules = folder / 'build' / 'mine'
    monkeypatch.setenv('PYTHONPATH', f'{os.environ.get("PYTHONPATH", "")}{os.pathsep}{modules}')
    return folder


def build(folder: Path) -> subprocess.CompletedProcess[str]:
    colcon = shutil.which('colcon')
    assert colcon
    words = (colcon, 'build', '--symlink-install')
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


def test_an_older_build_that_runs_is_named(workspace: Path, ros2: Callable[..., Any]) -> None:
    setup = workspace / 'src' / 'mine' / 'setup.py'
    right = setup.read_text()
    setup.write_text(right.replace(_ENTRY, f'{_ENTRY[:-1]} {_ENTRY}'))
    assert build(workspace).returncode == 2
    ran = ros2('run', 'mine', 'hello')
    assert ran.out == 'Hi from mine.\n'
    told = 'the last `colcon build` of it failed, so that an older one runs: setup.py:'
    assert ran.err.startswith(f'hint: mine: {told}')
    assert 'is there no comma behind the line before?; mend that, then run' in ran.err
    # The doctor has looked at the sources, and says it once.
    of_workspace = [x for x in ros2('doctor', folder=workspace).lines if '(workspace)' in x]
    assert len(of_workspace) == 1, of_workspace
    assert 'mine: colcon cannot build it: setup.py:' in of_workspace[0]

    setup.write_text(f'{right}\nraise RuntimeError("of the student")\n')
    assert build(workspace).returncode == 1
    (line,) = ros2('run', 'mine', 'hello').err.splitlines()
    ends = 'setup.py ends with an error, which `python3 setup.py --name` in '
    assert f'{told.removesuffix("setup.py:")}{ends}{setup.parent} shows; mend that' in line
    shows = subprocess.run(
        [sys.executable, 'setup.py', '--name'],
        cwd=setup.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert shows.stderr.endswith('RuntimeError: of the student\n')
    assert line.removeprefix('hint: ') in ros2('doctor', folder=workspace).of_check('workspace')


@pytest.mark.parametrize(
    ('program', 'told'),
    [
        (_NO_SPIN, 'mine/hello.py has a timer, but calls no rclpy.spin(), without which no callb'),
        (_TOO_SOON, 'mine/hello.py publishes before any subscription can have found it, so that '),
    ],
)
def test_a_program_that_ends_for_want_of_a_spin_is_told(
    workspace: Path, ros2: Callable[..., Any], program: str, told: str
) -> None:
    (workspace / 'src' / 'mine' / 'mine' / 'hello.py').write_text(program)
    ran = ros2('run', 'mine', 'hello')
    assert ran.status == 0
    (line,) = ran.err.splitlines()
    assert line.startswith('hint: mine: hello has ended, ')
    assert told in line


@pytest.mark.parametrize(
    ('code', 'told'),
    [
        ('publisher.publish(String())\ntime.sleep(1.0)', ''),
        ('# rclpy.spin(node)\nfuture = client.call_async(request)', 'write `rclpy.spin_until_fut'),
        (
            'future = client.call_async(request)\nrclpy.spin_until_future_complete(node, future)',
            '',
        ),
        ('print(1)', ''),
    ],
)
def test_a_program_that_ends_without_an_answer_is_told_and_another_is_not(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    code: str,
    told: str,
) -> None:
    (tmp_path / 'hello.py').write_text(code)
    monkeypatch.setattr('ros2_diagnosis.packages.source_of', lambda _: tmp_path)
    monkeypatch.setattr('ros2_diagnosis.setup_py.module_of', lambda *_: tmp_path / 'hello.py')
    early_ends.print_hint('mine', 'hello')
    err = capsys.readouterr().err
    assert told in err if told else err == ''


def test_a_program_whose_entry_point_was_renamed_is_told(
    workspace: Path, ros2: Callable[..., Any]
) -> None:
    setup = workspace / 'src' / 'mine' / 'setup.py'
    setup.write_text(setup.read_text().replace("'hello = ", "'hi = "))
    assert 'setup.py has changed since' in ros2('run', 'mine', 'hello').err
    assert build(workspace).returncode == 0
    ran = ros2('run', 'mine', 'hello')
    assert ran.status == 1
    assert ran.err == (
        f"No executable found: 'hello' is left of an older build, {setup} names it no more; there "
        f'is hi, and `rm {workspace}/install/mine/lib/mine/hello` takes it away\n'
    )
    ran = ros2('run', 'mine', 'hi')
    assert (ran.status, ran.err) == (0, '')


def test_a_workspace_that_was_renamed_is_told(
    workspace: Path, ros2: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = workspace.rename(workspace.with_name('renamed'))
    there = os.environ['AMENT_PREFIX_PATH'].replace(f'{workspace}/', f'{moved}/')
    monkeypatch.setenv('AMENT_PREFIX_PATH', there)
    told = (
        f'mine: it was built in {workspace}, and this workspace is another or was renamed, so '
        f'that no build of it ends well; `rm -r {moved}/build {moved}/install`, run `colcon '
        f'build` in {moved}, then open a new terminal'
    )
    ran = ros2('run', 'mine', 'hello')
    assert (ran.status, ran.err) == (1, f'No executable found: {told}\n')
    assert build(moved).returncode == 1  # as colcon ends everywhere
    assert ros2('run', 'mine', 'hello').err == ran.err
    (line,) = [x for x in ros2('doctor', folder=moved).lines if '(workspace)' in x]
    assert line == f'problem (workspace): {told}'
    shutil.rmtree(moved / 'build')
    shutil.rmtree(moved / 'install')
    assert build(moved).returncode == 0


def test_a_launch_file_that_was_renamed_stops_no_build_for_ever(
    workspace: Path, ros2: Callable[..., Any]
) -> None:
    source = workspace / 'src' / 'mine'
    (source / 'launch' / 'hello.launch.py').rename(source / 'launch' / 'hi.launch.py')
    assert build(workspace).returncode == 1
    (line,) = ros2('run', 'mine', 'hello').err.splitlines()
    assert 'build/mine/launch/hello.launch.py leads to a file that was renamed or removed' in line
    assert f'`rm -r {workspace}/build/mine` clears it; mend that, then run `colcon b' in line
    shutil.rmtree(workspace / 'build' / 'mine')
    assert build(workspace).returncode == 0
    assert ros2('run', 'mine', 'hello').err == ''


def test_a_build_among_the_sources_is_told_and_does_not_mislead(
    workspace: Path, ros2: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    for made in ('build', 'install', 'log'):
        shutil.rmtree(workspace / made)
    source = workspace / 'src'
    setup = source / 'mine' / 'setup.py'
    setup.write_text(setup.read_text().replace(_LAUNCH_FILES, ''))
    for place in (source / 'mine', source):
        among = build(place)
        assert among.returncode == 0
        assert among.stderr.count('hint: ') == 1
        assert among.stderr.startswith(
            f'hint: {place}: `colcon build` is called among the sources, where it makes build, '
            f'install and log of its own; call it in {workspace}\n'
        )
    for made in ('build', 'install', 'log'):
        shutil.rmtree(source / 'mine' / made)
    assert 'hint: ' not in build(workspace).stderr
    # What is left there is not where the package is built from now on.
    refused = ros2('launch', 'mine', 'hello.launch.py', folder=source)
    assert refused.err.endswith(f'run `colcon build --packages-select mine` in {workspace}\n')
    (source / 'mine' / 'mine' / 'other.py').write_text('def main():\n    pass\n')
    refused = ros2('run', 'mine', 'other', folder=source)
    assert refused.err.endswith(f'run `colcon build --packages-select mine` in {workspace}\n')

    prefixes = [str(source / 'install' / 'mine'), os.environ['AMENT_PREFIX_PATH']]
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
    (line,) = ros2('run', 'mine', 'hello').err.splitlines()
    assert line.startswith(
        f'hint: mine: `colcon build` was called in {source}, and what that made'
    )
    assert f'run `colcon build` in {workspace}, then open a new terminal' in line


def test_a_workspace_at_home_that_is_not_sourced_is_named(
    ros2: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('HOME', str(tmp_path))
    monkeypatch.chdir(tmp_path)
    install = tmp_path / 'my_ws' / 'install'
    index = install / 'husky_drive' / 'share' / 'ament_index' / 'resource_index' / 'packages'
    index.mkdir(parents=True)
    (index / 'husky_drive').touch()
    (install / 'setup.bash').touch()
    told = (
        f'it is built in {tmp_path}/my_ws, but not sourced in this terminal; run '
        f'`source {install}/setup.bash`'
    )
    for words in (('run', 'husky_drive', 'x'), ('launch', 'husky_drive', 'x.launch.py')):
        assert ros2(*words).err.endswith(f"'husky_drive' not found: {told}\n")
    # What is nowhere may be misspelt.
    assert "did you mean 'husky_driver'" in ros2('run', 'husky_drivr', 'x').err
