# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Log folder, formats and destinations."""

from collections.abc import Callable
from contextlib import suppress
import logging
from pathlib import Path
import re
import sys
import tempfile
from typing import Any

from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, LogInfo
from launch.logging import get_logger, get_output_loggers, handlers, launch_config, reset
import pytest

pytestmark = pytest.mark.usefixtures('launch_environment')

Run = Callable[..., Any]


def _run(*actions: Any, debug: bool = False) -> int:
    service = LaunchService(debug=debug)
    service.include_launch_description(LaunchDescription(actions))
    return service.run()


def test_the_log_folder_is_named_after_time_host_and_process(tmp_path: Path) -> None:
    _run(LogInfo(msg='hello'))
    folder = Path(launch_config.log_dir)
    assert folder.parent == tmp_path / 'ros_log'
    assert re.fullmatch(r'\d{4}(-\d{2}){5}-\d{6}-.+-\d+', folder.name)
    assert (tmp_path / 'ros_log' / 'latest').resolve() == folder.resolve()
    assert 'hello' in (folder / 'launch.log').read_text()


def test_ros_home_holds_the_logs_without_ros_log_dir(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv('ROS_LOG_DIR')
    monkeypatch.setenv('ROS_HOME', str(tmp_path / 'home'))
    reset()
    assert Path(launch_config.log_dir).parent == tmp_path / 'home' / 'log'


def test_a_log_folder_that_is_a_file_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'file').touch()
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'file'))
    monkeypatch.setattr(tempfile, 'tempdir', str(tmp_path))
    reset()
    with pytest.warns(UserWarning, match='cannot write logs below'):
        folder = Path(launch_config.log_dir)
    assert folder.is_dir()
    assert folder.is_relative_to(tmp_path)


def test_formats_may_come_from_the_environment(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv('OVERRIDE_LAUNCH_SCREEN_FORMAT', '<{message}>')
    monkeypatch.setenv('OVERRIDE_LAUNCH_LOG_FORMAT', '{levelname}!{message}')
    reset()
    _run(LogInfo(msg='hello'))
    assert '<hello>' in capsys.readouterr().out.splitlines()
    assert 'INFO!hello' in (Path(launch_config.log_dir) / 'launch.log').read_text().splitlines()


def test_formats_may_be_set(capsys: pytest.CaptureFixture[str]) -> None:
    launch_config.set_screen_format('default_with_timestamp')
    get_logger('launch').info('one')
    launch_config.set_screen_format('%(levelname)s %(message)s', screen_style='%')
    get_logger('launch').info('two')
    first, second = capsys.readouterr().out.splitlines()
    assert re.fullmatch(r'\d+\.\d{7} \[INFO\] \[launch\]: one', first)
    assert second == 'INFO two'
    with pytest.raises(ValueError, match='Cannot set a custom format style'):
        launch_config.set_screen_format('default', screen_style='{')


def test_streams_may_go_to_different_places(capsys: pytest.CaptureFixture[str]) -> None:
    command = ['sh', '-c', 'echo out; echo err >&2']
    _run(ExecuteProcess(cmd=command, output={'stdout': 'screen', 'stderr': {'log', 'own_log'}}))
    shown = capsys.readouterr().out
    assert re.search(r'^\[sh-\d+\] out$', shown, re.M)
    assert 'goes to the log alone' not in shown
    assert 'err' not in re.sub('process|cmd', '', shown).replace('\n', ' ').split()
    folder = Path(launch_config.log_dir)
    (own,) = folder.glob('sh-*-stderr.log')
    assert re.fullmatch(r'\[sh-\d+\] err\n', own.read_text())


def test_what_is_printed_where_nobody_sees_it_is_told_of(
    capsys: pytest.CaptureFixture[str],
) -> None:
    _run(ExecuteProcess(cmd=['echo', 'hidden'], respawn=True, respawn_max_retries=1))
    _run(ExecuteProcess(cmd=['sh', '-c', 'echo shown >&2']))
    shown = capsys.readouterr().out
    assert 'hidden' not in shown
    told = "what it prints goes to the log alone; output='screen' in the launch file shows it"
    assert re.findall(r'^\[INFO\] \[(\w+)-\d+\]: (.* shows it)$', shown, re.M) == [('echo', told)]


def test_a_last_line_without_an_end_is_shown_by_itself(
    capsys: pytest.CaptureFixture[str],
) -> None:
    half_a_letter = ExecuteProcess(
        cmd=['printf', r'caf\303'], output='screen', respawn=True, respawn_max_retries=1
    )
    assert _run(half_a_letter) == 0
    shown = capsys.readouterr().out
    assert re.findall(r'^\[printf-\d+\] (.*)$', shown, re.M) == ['caf\ufffd'] * 2


def test_an_output_format_may_name_the_pid(capsys: pytest.CaptureFixture[str]) -> None:
    text = '<{this.process_details[pid]:>9}> {line}'
    assert _run(ExecuteProcess(cmd=['echo', 'hi'], output='screen', output_format=text)) == 0
    shown = capsys.readouterr().out
    (pid,) = re.findall(r'started with pid \[(\d+)\]', shown)
    assert f'<{pid:>9}> hi' in shown.splitlines()


@pytest.mark.parametrize(
    ('output', 'message'),
    [
        ('scren', "output 'scren' is not a valid standard output config"),
        ({'stdin': 'log'}, "'stdin' is not a valid output source"),
        ({'both': {'paper'}}, 'paper is not a valid output destination'),
    ],
)
def test_a_wrong_destination_is_refused(output: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        get_output_loggers('process', output)


def test_the_environment_overrides_the_output_of_all_processes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv('OVERRIDE_LAUNCH_PROCESS_OUTPUT', 'screen')
    _run(ExecuteProcess(cmd=['echo', 'shown'], output='log'))
    assert re.search(r'^\[echo-\d+\] shown$', capsys.readouterr().out, re.M)


def test_debug_shows_the_traceback(capsys: pytest.CaptureFixture[str]) -> None:
    assert _run(ExecuteProcess(cmd=['']), debug=True) == 1
    output = capsys.readouterr().out
    assert 'Traceback (most recent call last)' in output
    assert '[DEBUG] [launch]: processing event' in output


def test_a_reset_forgets_levels_and_handlers(capsys: pytest.CaptureFixture[str]) -> None:
    get_logger('some-part').setLevel(logging.ERROR)
    launch_config.reset()
    reset()
    get_logger('some-part').info('once')
    assert capsys.readouterr().out == '[INFO] [some-part]: once\n'


def test_other_handlers_of_logging_can_be_used() -> None:
    made: list[logging.Handler] = []

    def factory(path: str, encoding: str | None = None) -> logging.Handler:
        rotating: Any = handlers.RotatingFileHandler
        made.append(rotating(path, maxBytes=1024, backupCount=3, encoding=encoding))
        return made[-1]

    launch_config.log_handler_factory = factory
    _run(LogInfo(msg='hello'))
    assert len(made) == 1
    with pytest.raises(AttributeError, match='no attribute'):
        _ = handlers.NoSuchHandler


def test_a_disk_that_is_full_is_said_once_and_stops_nothing(
    capsys: pytest.CaptureFixture[str],
) -> None:
    launch_config.log_handler_factory = lambda *_, **_options: handlers.FileHandler('/dev/full')
    assert _run(LogInfo(msg='one'), LogInfo(msg='two')) == 0
    said = capsys.readouterr()
    assert '[launch.user]: two' in said.out
    assert said.err.startswith('cannot write /dev/full (No space left on device): ')
    assert said.err.count('\n') == 1


def test_nor_does_one_that_is_full_where_the_output_goes(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with suppress(OSError), Path('/dev/full').open('w') as full:  # also to close it would fail
        monkeypatch.setattr(sys, 'stdout', full)
        assert _run(LogInfo(msg='one'), LogInfo(msg='two')) == 0
    err = capfd.readouterr().err
    assert err.startswith('cannot write standard output (No space left on device): ')
    assert err.count('\n') == 1
