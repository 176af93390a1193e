# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Children are ended with everything that they have started."""

import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import adopt_orphans, descendants_ended
from playpen_testing.waiting import wait_until
import psutil

# A daemon: neither in the session of its child, nor below it.
DAEMON = """
import os, sys, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        print(os.getpid(), flush=True)
        time.sleep(600)
    os._exit(0)
os.wait()
time.sleep(600)
"""
IGNORING = """
import signal, time
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
print('ready', flush=True)
time.sleep(600)
"""
CLOSING = """
import signal, sys, time
def close(*_):
    time.sleep(0.3)
    print('closed', flush=True)
    sys.exit()
signal.signal(signal.SIGTERM, close)
print('ready', flush=True)
time.sleep(600)
"""
# Ends at once on SIGTERM, as a launch of Jazzy's; what it has started needs a moment.
HASTY = f"""
import subprocess, sys
subprocess.run([sys.executable, '-c', {CLOSING!r}])
"""
PARENT = """
import os, sys
from husky_runtime.children import ChildProcess
child = ChildProcess([sys.executable, '-c', 'import time; time.sleep(600)'], os.environ)
print(child.pid, flush=True)
sys.stdin.read()
"""
IGNORING_CHILD = f"""
import os, signal, sys
from husky_runtime.children import ChildProcess
child = ChildProcess([sys.executable, '-c', {IGNORING!r}], os.environ, parent_death=signal.SIGKILL)
print(child.pid, flush=True)
sys.stdin.read()
"""
FAMILY = """
import os, time
if os.fork() == 0:
    os.setsid()
os.write(1, f'{os.getpid()}\\n'.encode())  # whole lines, of two at once
time.sleep(60)
"""
NOHUP = """
import os, sys
from husky_runtime.supervise import run_to_end
hang_up = 'import os, signal, sys, time; os.kill(os.getppid(), signal.SIGHUP); '
hang_up += 'time.sleep(float(sys.argv[1])); print("goes on")'
sys.exit(run_to_end([sys.executable, '-c', hang_up, sys.argv[1]], os.environ))
"""

SUPERVISED = f"""
import os, sys
from husky_runtime.supervise import run_to_end
run_to_end([sys.executable, '-c', {FAMILY!r}], os.environ)
"""


def start(text: str, log: Path) -> ChildProcess:
    with log.open('w') as stream:
        process = ChildProcess([sys.executable, '-c', text], os.environ, stream)
    wait_until(lambda: log.read_text().endswith('\n'), what='the first line of the child')
    return process


def states(pids: list[int]) -> set[str]:
    return {psutil.Process(pid).status() for pid in pids}


def is_running(pid: int) -> bool:
    try:
        return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return False


def test_a_daemon_ends_with_the_child_that_made_it(tmp_path: Path) -> None:
    adopt_orphans()
    with start(DAEMON, tmp_path / 'log'):
        daemon = int((tmp_path / 'log').read_text())
        assert is_running(daemon)
    assert not is_running(daemon)


def test_a_child_that_ignores_signals_ends_in_2_s(tmp_path: Path) -> None:
    process = start(IGNORING, tmp_path / 'log')
    begun = time.monotonic()
    process.end()
    assert process.exit_code == -signal.SIGKILL
    assert time.monotonic() - begun < 2.2


def test_what_a_hasty_child_has_started_may_close(tmp_path: Path) -> None:
    process = start(HASTY, tmp_path / 'log')
    process.end(signal.SIGTERM, within_sec=20.0, firm_sec=20.0)
    assert process.exit_code == -signal.SIGTERM
    assert (tmp_path / 'log').read_text() == 'ready\nclosed\n'


def test_a_child_ends_with_its_killed_parent() -> None:
    parent = subprocess.Popen(
        [sys.executable, '-c', PARENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert parent.stdout is not None
    child = int(parent.stdout.readline())
    assert is_running(child)
    parent.kill()
    parent.communicate()
    wait_until(lambda: not is_running(child), what='the end of the child')


def test_a_child_that_ignores_signals_ends_with_its_parent() -> None:
    parent = subprocess.Popen(
        [sys.executable, '-c', IGNORING_CHILD],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert parent.stdout is not None
    told = {parent.stdout.readline().strip(), parent.stdout.readline().strip()}
    (child,) = map(int, told - {'ready'})
    assert is_running(child)
    parent.kill()
    parent.communicate()
    wait_until(lambda: not is_running(child), what='the end of the child')


def test_a_daemon_that_lost_its_mark_ends_too(tmp_path: Path) -> None:
    log = tmp_path / 'log'
    with descendants_ended():
        with log.open('w') as stream:
            command = ['env', '-i', sys.executable, '-c', DAEMON]
            child = ChildProcess(command, os.environ, stream)
        wait_until(lambda: log.read_text().endswith('\n'), what='the daemon')
        daemon = int(log.read_text())
        child.end()
        assert is_running(daemon), 'it has no mark'
    assert not is_running(daemon)


def test_under_nohup_a_run_outlives_its_terminal(tmp_path: Path) -> None:
    ends, goes_on = ('', 128 + signal.SIGHUP), ('goes on\n', 0)
    for prefix, seconds, expected in ([], '60', ends), (['nohup'], '0.5', goes_on):
        run = subprocess.run(
            [*prefix, sys.executable, '-c', NOHUP, seconds],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=20.0,
        )
        assert (run.stdout, run.returncode) == expected, run.stderr


def test_ctrl_z_stops_a_run_and_fg_goes_on() -> None:
    run = subprocess.Popen(
        [sys.executable, '-c', SUPERVISED],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=os.setpgrp,  # a job of its own, as a shell makes it
    )
    assert run.stdout is not None
    pids = [run.pid, int(run.stdout.readline()), int(run.stdout.readline())]
    for _ in range(20):  # one in 400 was lost that came as soon as the run went on
        os.killpg(run.pid, signal.SIGTSTP)
        wait_until(lambda: states(pids) == {psutil.STATUS_STOPPED}, what=f'all of {pids} stopped')
        os.killpg(run.pid, signal.SIGCONT)
        wait_until(
            lambda: psutil.STATUS_STOPPED not in states(pids), what=f'none of {pids} stopped'
        )
    os.killpg(run.pid, signal.SIGTSTP)
    wait_until(
        lambda: states(pids) == {psutil.STATUS_STOPPED}, what=f'all of {pids} stopped again'
    )
    run.terminate()  # as a shell does that is told to end a stopped job
    os.killpg(run.pid, signal.SIGCONT)
    run.communicate(timeout=10.0)
    assert run.returncode == 128 + signal.SIGTERM
    assert not any(map(is_running, pids))
