# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 launch`: finds the file, shows and passes its arguments, ends with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch import LaunchDescription
from launch.actions import LogInfo
import launch.logging
import pytest
from ros2launch import api
from ros2launch.option import OptionExtension

_LAUNCH = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration
def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('who', default_value='world', description='Whom to greet.'),
        DeclareLaunchArgument('must', description='Has no default.', choices=['a', 'b']),
        LogInfo(msg=['hello ', LaunchConfiguration('who')]),
    ])
"""


@pytest.fixture
def package(
    installed_package: Callable[..., Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Path:
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'log'))
    folder = installed_package('demo') / 'share' / 'demo' / 'launch'
    folder.mkdir()
    (folder / 'greet.launch.py').write_text(_LAUNCH)
    return folder


@pytest.mark.usefixtures('package')
def test_a_package_and_a_file_are_launched_with_arguments(ros2: Callable[..., Any]) -> None:
    answer = ros2('launch', 'demo', 'greet.launch.py', 'who:=you', 'must:=a')
    assert answer.status == 0
    assert 'hello you' in answer.out + answer.err


def test_a_path_is_launched_too(package: Path, ros2: Callable[..., Any]) -> None:
    answer = ros2('launch', str(package / 'greet.launch.py'), 'must:=b')
    assert answer.status == 0
    assert 'hello world' in answer.out + answer.err


def test_no_file_of_ros2_launch_is_named_as_the_place_of_an_error(
    package: Path, ros2: Callable[..., Any]
) -> None:
    path = package / 'latin.launch.xml'
    path.write_bytes(b'<launch><log message="gr\xfcn"/></launch>')
    answer = ros2('launch', str(path))
    assert answer.status == 1
    assert "'utf-8' codec can't decode byte" in answer.out + answer.err
    assert 'ros2launch' not in answer.out + answer.err


def test_an_import_that_has_no_wheel_is_said(package: Path, ros2: Callable[..., Any]) -> None:
    path = package / 'greet.launch.py'
    path.write_text(f'import webots_ros2_driver\n{_LAUNCH}')
    told = "No module named 'webots_ros2_driver': it has no wheel; here `ros2 launch husky_sim"
    assert ros2('launch', str(path)).out.count(told) == 1


@pytest.mark.usefixtures('package')
def test_arguments_are_shown(ros2: Callable[..., Any]) -> None:
    answer = ros2('launch', 'demo', 'greet.launch.py', '--show-args')
    assert answer.lines == [
        "Arguments (pass arguments as '<name>:=<value>'):",
        '',
        "    'who':",
        '        Whom to greet.',
        "        (default: 'world')",
        '',
        "    'must':",
        "        Has no default. Valid choices are: ['a', 'b']",
    ]


@pytest.mark.usefixtures('package')
def test_the_description_is_printed_without_a_launch(ros2: Callable[..., Any]) -> None:
    answer = ros2('launch', '--print', 'demo', 'greet.launch.py')
    assert answer.status == 0
    assert 'LogInfo' in answer.out
    assert 'hello world' not in answer.out


@pytest.mark.usefixtures('package')
@pytest.mark.parametrize(
    ('words', 'message'),
    [
        (('demo',), "package 'demo' has greet.launch.py"),
        (('demo', 'gret.launch.py'), "did you mean 'greet.launch.py'?"),
        (('dmo', 'greet.launch.py'), "did you mean 'demo'?"),
        (('./nothing.launch.py',), "'./nothing.launch.py' is no file"),
        (('demo', 'greet.launch.py', 'who=you'), "malformed launch argument 'who=you'"),
        (('demo', 'greet.launch.py', 'who:='), "malformed launch argument 'who:='"),
        (('demo', 'greet.launch.py', '--launch-prefix-filter', 'x'), 'but no --launch-prefix'),
        (('demo', 'greet.launch.py'), 'must'),
    ],
)
def test_what_cannot_be_launched_is_said(
    ros2: Callable[..., Any], words: tuple[str, ...], message: str
) -> None:
    answer = ros2('launch', *words)
    assert answer.status == 1
    assert message in answer.err + answer.out


class _Shout(OptionExtension):
    """Greets in another way, and notes what it was asked."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[Any] = []

    def prestart(self, args: Any) -> None:
        self.asked.append('prestart')

    def prelaunch(self, launch_description: Any, args: Any) -> tuple[LaunchDescription, ...]:
        return (LaunchDescription([LogInfo(msg='HELLO'), launch_description]),)

    def postlaunch(self, launch_return_code: int, args: Any) -> None:
        self.asked.append(launch_return_code)


def test_other_programs_launch_files_with_options(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = api.get_share_file_path_from_package(package_name='demo', file_name='greet.launch.py')
    assert path == str(package / 'greet.launch.py')
    assert api.get_launch_file_paths(path=str(package)) == [path]
    shout = _Shout()
    launch.logging.reset()
    status = api.launch_a_launch_file(
        launch_file_path=path,
        launch_file_arguments=['must:=a', 'whom:=you'],
        option_extensions={'shout': shout},
    )
    launch.logging.reset()
    assert (status, shout.asked) == (0, ['prestart', 0])
    output = capsys.readouterr().out
    assert 'HELLO' in output
    assert 'hello world' in output
    assert "'whom' is not declared" in output
