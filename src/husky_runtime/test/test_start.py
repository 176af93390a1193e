# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that can be interrupted at any moment."""

import fcntl
import os
from pathlib import Path
import pty
import select
import signal
import subprocess
import sys
import termios

from playpen_testing.processes import Child
from playpen_testing.waiting import wait_until
import pytest

INTERRUPTED = 130
# Python prints and forgets what is raised in such a callback.
FORGETFUL = """
import os, signal, time, weakref

class Thing:
    pass

def main():
    thing = Thing()
    reference = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGINT))
    del thing
    time.sleep(20.0)
    print('never interrupted')
    return 0
"""


# What main() imports when it needs it, as a user presses Ctrl-C.
LOADS = """
import os, signal, time
os.kill(os.getpid(), signal.SIGINT)
print('loaded')
"""
NEEDS = """
import time

def main():
    try:
        import loads
        time.sleep(20.0)
    finally:
        print('closed')
    return 0
"""


SAYS = """
import sys

def main():
    with open('file', 'w') as file:
        print('to nobody')
        print('what was there to read:', sys.stdin.read(), file=file)
    return 0
"""


# Ctrl-C, as a terminal hands it to all of its foreground: to the shell and to the program.
WAITS = """
import os, signal, sys, time
from husky_runtime.start import run

def main():
    os.killpg(0, signal.SIGINT)
    time.sleep(20.0)
    return 0

sys.exit(run(lambda: main, interrupted=130, catches=True))
"""


# Both print what nobody reads; the second one in another process.
PRINTS = """
import sys
from husky_runtime.start import run

def main():
    while True:
        print('progress', file=sys.stderr)

sys.exit(run(lambda: main, interrupted=130, catches=True))
"""
SUPERVISES = """
import sys
from husky_runtime.supervise import program

sys.argv[1:] = ['yes']
sys.exit(program())
"""


def started(
    folder: Path, program: str, *words: str, shell: str = 'exec "$@"'
) -> 'subprocess.CompletedProcess[str]':
    return subprocess.run(
        ['bash', '-c', shell, 'bash', sys.executable, '-c', program, *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=30.0,
        check=False,
    )


def test_what_is_printed_where_nothing_is_open_gets_into_no_file(tmp_path: Path) -> None:
    (tmp_path / 'says.py').write_text(SAYS)
    program = (
        'import sys; from says import main; from husky_runtime.start import run; '
        'sys.exit(run(lambda: main))'
    )
    ended = started(tmp_path, program, shell='exec "$@" <&- >&-')
    assert (ended.returncode, ended.stderr) == (0, '')
    assert (tmp_path / 'file').read_text() == 'what was there to read: \n'


@pytest.mark.parametrize(
    ('words', 'said'),
    [
        (['--ros-args', '-p', 'x:=['], 'wrong ROS arguments: Failed to parse ROS arguments: '),
        (['--ros-args', '--params-file', '/none'], "Couldn't parse params file: "),
        (['\udcff.yaml'], 'an argument is no UTF-8, and ROS takes nothing else'),
        (['scan:=true'], "-c: 'scan:=true' is refused: parameters and other names stand"),
        (['--ros-args', '--', 'x:=1.0'], '`-c --ros-args -p x:=1.0`'),
        (['-p', 'x:=1.0'], '`-c --ros-args -p x:=1.0`'),
    ],
)
def test_wrong_ros_arguments_are_refused_in_one_line(
    tmp_path: Path, words: list[str], said: str
) -> None:
    program = (
        'import sys; from husky_runtime.start import run_node; '
        'sys.exit(run_node(lambda: lambda: print("it runs")))'
    )
    ended = started(tmp_path, program, *words)
    assert (ended.returncode, ended.stdout) == (2, '')
    (line,) = ended.stderr.splitlines()
    assert said in line


def test_what_ros_refuses_at_a_start_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_LOG_DIR', '/proc/none')
    program = (
        'import sys, rclpy; from husky_runtime.start import run_node; '
        'sys.exit(run_node(lambda: rclpy.init))'
    )
    ended = started(tmp_path, program)
    assert ended.returncode == 2
    assert 'Failed to create log directory' in ended.stderr.splitlines()[-1]
    assert 'Traceback' not in ended.stderr


def test_an_interrupt_in_a_weakref_callback_is_not_lost(tmp_path: Path) -> None:
    (tmp_path / 'forgetful.py').write_text(FORGETFUL)
    program = (
        'import sys; from forgetful import main; from husky_runtime.start import run; '
        f'sys.exit(run(lambda: main, interrupted={INTERRUPTED}, catches=True))'
    )
    ended = started(tmp_path, program)
    assert (ended.returncode, ended.stdout, ended.stderr) == (INTERRUPTED, '', '')


def test_an_interrupt_amid_an_import_of_main_closes_what_is_open(tmp_path: Path) -> None:
    (tmp_path / 'loads.py').write_text(LOADS)
    (tmp_path / 'needs.py').write_text(NEEDS)
    program = (
        'import sys; from needs import main; from husky_runtime.start import run; '
        f'sys.exit(run(lambda: main, interrupted={INTERRUPTED}, catches=True))'
    )
    ended = started(tmp_path, program)
    assert (ended.returncode, ended.stdout) == (INTERRUPTED, 'loaded\nclosed\n')


def test_ctrl_c_ends_the_loop_of_a_shell(tmp_path: Path) -> None:
    (tmp_path / 'waits.py').write_text(WAITS)
    keyboard, terminal = pty.openpty()
    loop = f'for course in 1 2; do {sys.executable} waits.py; echo the next; done'
    with subprocess.Popen(
        ['bash', '-c', loop],
        cwd=tmp_path,
        stdin=terminal,
        stdout=subprocess.PIPE,
        stderr=terminal,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
    ) as shell:
        os.close(terminal)
        said, _ = shell.communicate(timeout=30.0)
    os.close(keyboard)
    assert (said, shell.returncode) == ('', -signal.SIGINT)


@pytest.mark.parametrize(
    ('program', 'number', 'status'),
    [
        pytest.param(PRINTS, signal.SIGINT, INTERRUPTED, id='prints'),
        pytest.param(SUPERVISES, signal.SIGINT, INTERRUPTED, id='supervises'),
        pytest.param(SUPERVISES, signal.SIGTERM, 128 + signal.SIGTERM, id='supervises, SIGTERM'),
    ],
)
def test_who_waits_for_a_reader_can_be_interrupted(program: str, number: int, status: int) -> None:
    read, write = os.pipe()
    with Child([sys.executable, '-c', program], stdout=write, stderr=write) as child:
        wait_until(lambda: not select.select([], [write], [], 0.0)[1], what='a full pipe')
        child.send_signal(number)
        assert child.wait(10.0) == status
    os.close(read)
    os.close(write)
