# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 run`: it stands for the program, and says why there is none."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys
from typing import Any

from interrupt_while_loading import words_of
import pytest
from ros2_diagnosis import programs

_SHOW = '#!/bin/sh\necho "$$" "$@"\n'


def test_the_exit_status_is_that_of_the_program(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    installed_package('demo', seven='#!/bin/sh\nexit 7\n', killed='#!/bin/sh\nkill -9 $$\n')
    answer = ros2('run', 'demo', 'seven')
    assert (answer.status, answer.out) == (7, '[ros2run]: Process exited with failure 7\n')
    answer = ros2('run', 'demo', 'killed')
    assert (answer.status, answer.out) == (256 - 9, '[ros2run]: Killed\n')


def test_every_argument_behind_the_executable_is_passed_on(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    installed_package('demo', show=_SHOW)
    words = ('-h', '--prefix', 'x', '--ros-args', '-r', '__node:=me', '--', 'a b')
    assert ros2('run', 'demo', 'show', *words).out.split(' ', 1)[1] == ' '.join(words) + '\n'


def test_a_prefix_goes_before_the_program(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    prefix = installed_package('demo', show=_SHOW)
    answer = ros2('run', '--prefix', 'echo "a b"', 'demo', 'show', 'c')
    assert answer.out == f'a b {prefix}/lib/demo/show c\n'


def test_a_script_for_the_python_of_ubuntu_runs_by_this_one(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    prints = 'import sys\nprint(sys.prefix, *sys.argv)\n'
    prefix = installed_package('demo', node=f'#!/usr/bin/python3\n{prints}')
    assert ros2('run', 'demo', 'node', 'a b').out == f'{sys.prefix} {prefix}/lib/demo/node a b\n'
    tool = shutil.copy(prefix / 'lib/demo/node', prefix / 'tool')  # in no package: as it says
    assert words_of([str(tool)]) == [str(tool)]


def test_xacro_is_a_package_with_a_program(ros2: Callable[..., Any], tmp_path: Path) -> None:
    macros = "xmlns:xacro='http://www.ros.org/wiki/xacro'"
    file = tmp_path / 'arm.xacro'
    file.write_text(f"<robot {macros}><link name='${{1 + 1}}$(arg side)'/></robot>")
    answer = ros2('run', 'xacro', 'xacro', str(file), 'side:=left')
    assert (answer.status, answer.err) == (0, '')
    assert '<link name="2left"/>' in answer.out
    assert ros2('pkg', 'prefix', 'xacro').lines == [sys.prefix]


_COUNTS = f"""#!{sys.executable}
import signal, sys, time
got = []
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda number, _: got.append(number))
print('ready', flush=True)
while not got:
    time.sleep(0.01)
time.sleep(0.2)  # for a second one
sys.exit(10 * len(got) + got[0])
"""


@pytest.mark.parametrize('send', [os.kill, os.killpg])
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_signal_reaches_the_program_once_and_nothing_is_left(
    installed_package: Callable[..., Path],
    number: signal.Signals,
    send: Callable[[int, signal.Signals], None],
) -> None:
    installed_package('demo', counts=_COUNTS)
    process = subprocess.Popen(
        [sys.executable, '-m', 'ros2cli', 'run', 'demo', 'counts'],
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == 'ready\n'
    send(process.pid, number)
    process.communicate(timeout=5)  # to the end of the output, which the program has too
    assert process.returncode == (-number if number is signal.SIGKILL else 10 + number)


_AT_ONCE = """#!/bin/sh
trap 'got=$((got + 1))' INT
kill -INT 0
for again in 1 2; do sleep 0.1; done  # for a second one
exit $got
"""


def test_a_signal_at_the_start_of_the_program_reaches_it_once(
    installed_package: Callable[..., Path],
) -> None:
    installed_package('demo', at_once=_AT_ONCE)
    command = [sys.executable, '-m', 'ros2cli', 'run', 'demo', 'at_once']
    ends = {subprocess.run(command, start_new_session=True).returncode for _ in range(5)}
    assert ends == {1}


_BEFORE_IT_IS_THERE = """
import os, signal, subprocess, sys
from ros2run import child

start = subprocess.Popen

def start_late(*command, **options):
    os.killpg(0, signal.SIGINT)
    return start(*command, **options)

subprocess.Popen = start_late
sys.exit(child.run(sys.argv[1:]))
"""


def test_ctrl_c_just_before_the_program_is_there_reaches_it_once(
    installed_package: Callable[..., Path],
) -> None:
    program = installed_package('demo', counts=_COUNTS) / 'lib' / 'demo' / 'counts'
    command = [sys.executable, '-c', _BEFORE_IT_IS_THERE, str(program)]
    run = subprocess.run(command, start_new_session=True, timeout=10)
    assert run.returncode == 256 - signal.SIGINT  # Python had it as it started


@pytest.mark.parametrize(
    ('words', 'status', 'message'),
    [
        (('demo', 'sho'), 1, "package 'demo' has no 'sho'; did you mean 'show'?"),
        (('dmo', 'show'), 1, "Package 'dmo' not found: no such package is sourced or installed; "
                             "did you mean 'demo'?"),
        (('demo',), 2, "the name of the executable is missing; package 'demo' has show"),
        (('--prefix', '"', 'demo', 'show'), 2, 'is refused: No closing quotation'),
        (('demo', 'broken'), 1, "its first line names '/no/python'"),
        (('demo', 'dos'), 1, "as those of Windows (CRLF), so that it asks for '/usr/bin/env sh' "),
        (('demo', 'still'), 1, 'lib/demo/still is not executable: `chmod +x '),
        (('empty', 'x'), 1, "package 'empty' has none"),
    ],
)  # fmt: skip
def test_what_cannot_run_is_explained(
    installed_package: Callable[..., Path],
    ros2: Callable[..., Any],
    words: tuple[str, ...],
    status: int,
    message: str,
) -> None:
    scripts = {'show': _SHOW}
    if 'broken' in words:
        scripts['broken'] = '#!/no/python\n'
    if 'dos' in words:
        scripts['dos'] = '#!/usr/bin/env sh\r\necho\r\n'
    if 'still' in words:
        scripts['still'] = _SHOW
    prefix = installed_package('demo', **scripts)
    if 'still' in words:
        (prefix / 'lib/demo/still').chmod(0o644)
    installed_package('empty')
    answer = ros2('run', *words)
    assert answer.status == status
    assert message in answer.err


def test_a_disk_from_which_nothing_may_be_run_is_known() -> None:
    options = {}
    for line in Path('/proc/mounts').read_text().splitlines():
        _, place, _, words, *_ = line.split()
        options[place] = words.split(',')
    places = {'/', '/proc', '/sys', '/dev', '/dev/shm', '/run', '/tmp'} & set(options)
    told = {place: programs.nothing_runs_on(Path(place)) for place in places}
    assert told == {place: 'noexec' in options[place] for place in places}


def test_executables_of_one_name_are_all_named(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    prefix = installed_package('demo', show=_SHOW)
    second = prefix / 'lib' / 'demo' / 'tools' / 'show'
    second.parent.mkdir()
    second.write_text(_SHOW)
    second.chmod(0o755)
    answer = ros2('run', 'demo', 'show')
    assert answer.status == 1
    assert answer.err.startswith("Multiple executables named 'show' in package 'demo'")
    assert str(second) in answer.err


def test_the_first_prefix_wins(
    installed_package: Callable[..., Path],
    ros2: Callable[..., Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    first = installed_package('demo', show='#!/bin/sh\necho first\n')
    second = tmp_path / 'second'
    for folder in ('lib/demo', 'share/ament_index/resource_index/packages'):
        (second / folder).mkdir(parents=True)
    (second / 'share/ament_index/resource_index/packages/demo').touch()
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'{first}{os.pathsep}{second}')
    assert ros2('run', 'demo', 'show').out == 'first\n'
