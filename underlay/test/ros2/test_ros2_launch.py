# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 launch`: finds the file, shows and passes its arguments, ends with it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

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
        (('demo', 'greet.launch.py'), 'must'),
    ],
)
def test_what_cannot_be_launched_is_said(
    ros2: Callable[..., Any], words: tuple[str, ...], message: str
) -> None:
    answer = ros2('launch', *words)
    assert answer.status == 1
    assert message in answer.err + answer.out
