# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What colcon and ros2 say of packages that are broken, have changed, or are built elsewhere."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import subprocess
import sys

from playpen_testing.talk_package import FILES, replace, write_package
import pytest
from ros2_diagnosis import PackageError, packages, workspaces


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_package(tmp_path / 'src' / 'talk')


def broken(tmp_path: Path, name: str, file: str, change: Callable[[str], bytes]) -> str:
    """Write a package of another name, with a change in one of its files."""
    folder = write_package(tmp_path / 'src' / name)
    for path in ('package.xml', 'setup.py', 'setup.cfg'):
        replace(folder / path, 'talk', name)
    (folder / 'talk').rename(folder / name)
    (folder / 'resource' / 'talk').rename(folder / 'resource' / name)
    (folder / file).write_bytes(change((folder / file).read_text()))
    return name


def test_colcon_says_that_a_file_is_missing(tmp_path: Path) -> None:
    for name, file, text in (
        ('talk', 'package.xml', FILES['package.xml']),
        ('gone', 'setup.py', FILES['setup.py']),
        ('lost', 'CMakeLists.txt', 'project(robot)\nfind_package(ament_cmake REQUIRED)\n'),
    ):
        (tmp_path / 'src' / name).mkdir(parents=True)
        (tmp_path / 'src' / name / file).write_text(text)
    command = [sys.executable, '-m', 'colcon', 'build', '--continue-on-error']
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert 'talk: setup.py: there is none; package.xml says ament_python' in done.stderr
    for name in ('gone', 'lost'):
        assert f'{name}: package.xml: there is none, by which ROS knows a pack' in done.stderr
    assert 'Traceback' not in done.stderr
    assert done.returncode == 2


def test_colcon_and_ros2_run_say_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    broken(tmp_path, 'marked', 'setup.cfg', lambda text: f'\ufeff{text}'.encode())
    broken(tmp_path, 'wide', 'package.xml', lambda text: text.encode('utf-16'))
    broken(tmp_path, 'open_tag', 'package.xml', lambda text: text.replace('</name>', '').encode())
    broken(tmp_path, 'bare', 'setup.py', lambda text: text.encode())
    (tmp_path / 'src' / 'bare' / 'package.xml').unlink()
    broken(tmp_path, 'ignored', 'setup.py', lambda text: text.encode())
    (tmp_path / 'src' / 'ignored' / 'COLCON_IGNORE').touch()
    (tmp_path / 'src' / 'cpp').mkdir()
    (tmp_path / 'src' / 'cpp' / 'CMakeLists.txt').write_text(
        'project(cpp)\nadd_executable(a a.cpp)\n'
    )
    (tmp_path / 'src' / 'cpp' / 'package.xml').write_text(
        FILES['package.xml'].replace('talk', 'cpp').replace('ament_python', 'ament_cmake')
    )
    command = [sys.executable, '-m', 'colcon', 'build', '--continue-on-error', '--symlink-install']
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2
    assert 'Finished <<< talk' in done.stdout
    assert 'Traceback' not in done.stderr
    for line in (
        'marked: setup.cfg begins with a byte order mark',
        'wide: package.xml is saved as UTF-16',
        'open_tag: package.xml: mismatched tag: line ',
        'bare: package.xml: there is none',
    ):
        assert line in done.stderr

    monkeypatch.chdir(tmp_path)
    for name, reason in (
        ('marked', 'colcon cannot build it: setup.cfg begins with a byte order mark'),
        ('wide', 'colcon cannot build it: package.xml is saved as UTF-16'),
        ('open_tag', 'colcon cannot build it: package.xml: mismatched tag'),
        ('ignored', f'for {tmp_path / "src/ignored/COLCON_IGNORE"}; remove that and run `colcon'),
        ('cpp', '`colcon build` failed: cpp: CMakeLists.txt:2: add_executable'),
        ('talk', 'it is built in'),
    ):
        assert reason in packages.why_missing(name)

    findings = [str(each) for each in workspaces.check_built_and_sourced(tmp_path)]
    marked = 'marked: colcon cannot build it: setup.cfg begins with a byte order mark'
    assert sum(line.startswith(marked) for line in findings) == 1
    assert not any('marked' in line for line in findings if not line.startswith('marked: colcon'))

    prefix = tmp_path / 'install' / 'talk'
    monkeypatch.setenv(
        'AMENT_PREFIX_PATH', f'{prefix}{os.pathsep}{os.environ["AMENT_PREFIX_PATH"]}'
    )
    monkeypatch.setenv('PYTHONPATH', str(prefix / 'lib/python3/site-packages'))
    (finding,) = workspaces.check_changed('talk', prefix)  # as if it was built as copies before
    assert str(finding).startswith('talk: built with `--symlink-install` since this terminal was')
    (link := tmp_path / 'link').symlink_to(tmp_path)
    monkeypatch.setenv('PYTHONPATH', str(link / 'build' / 'talk'))
    assert list(workspaces.check_changed('talk', prefix)) == []
    # A second workspace has a package of that name, and is sourced without this one or after it.
    other = tmp_path / 'other'
    shutil.copytree(tmp_path / 'install', other / 'install', symlinks=True)
    found = os.environ['AMENT_PREFIX_PATH'].partition(os.pathsep)[2]
    for prefixes, line in (
        ([other / 'install' / 'talk'], f'talk: built in {tmp_path}, but not sourced in this'),
        (
            [other / 'install' / 'talk', prefix],
            f'talk: that of {other} runs here, because it was sourced after {tmp_path}; open a '
            f'new terminal and `source {tmp_path}/install/setup.bash` last, if you mean this one',
        ),
        ([prefix, other / 'install' / 'talk'], ''),
    ):
        with monkeypatch.context() as elsewhere:
            elsewhere.setenv('AMENT_PREFIX_PATH', os.pathsep.join([*map(str, prefixes), found]))
            findings = [str(each) for each in workspaces.check_built_and_sourced(tmp_path)]
        about_talk = [each for each in findings if each.startswith('talk: ')]
        assert [each[: len(line)] for each in about_talk] == [line] * bool(line), about_talk
    (folder / 'bye.py').write_text(FILES['talk/hello.py'])
    with pytest.raises(PackageError, match='No executable found') as refused:
        packages.find_executable('talk', 'bye.py')
    there = f"bye.py is not in {folder}/talk, that of the programs: move it there, and add 'bye "
    assert there in str(refused.value)
    (folder / 'bye.py').unlink()
    replace(folder / 'talk' / 'hello.py', 'main', 'mian')
    (finding,) = workspaces.check_changed('talk', prefix)
    assert 'hello of setup.py cannot start: ' in str(finding)

    (folder / 'launch').mkdir()
    launch_file = folder / 'launch' / 'talk.launch.py'
    launch_file.touch()
    assert packages.why_not_installed('talk', 'talks.launch.py') is None
    told = packages.why_not_installed('talk', 'talk.launch.py')
    assert told is not None
    assert told.startswith(f"{launch_file} is not installed: add ('share/talk/launch', glob('laun")
    replace(folder / 'setup.py', '    ],\n    entry', "('x', glob('launch/*.py'))],\n    entry")
    told = packages.why_not_installed('talk', 'talk.launch.py')
    assert told is not None
    assert told.startswith(f'{launch_file} is not installed yet: run `colcon build')
    (folder / 'urdf').mkdir()
    (folder / 'urdf' / 'arm.urdf').touch()
    share = prefix / 'share' / 'talk'
    told = packages.why_not_in_share(share / 'urdf' / 'arm.urdf')
    assert told is not None
    assert told.startswith(f"{folder}/urdf/arm.urdf is not installed: add ('share/talk/urdf', glo")
    for other in (share / 'arm.urdf', share, folder / 'urdf' / 'arm.urdf'):
        assert packages.why_not_in_share(other) is None

    assert [str(each) for each in workspaces.check_changed('talk', prefix)] != []
    replace(folder / 'package.xml', '>talk<', '>chat<')
    (finding,) = workspaces.check_changed('talk', prefix)
    assert str(finding).startswith(f'talk: an old build: {tmp_path} has no sources of it any more')
    assert f'`rm -r {prefix} {tmp_path / "build/talk"}`' in str(finding)
