# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Children are ended with everything that they have started."""

from collections.abc import Callable
import fcntl
import os
from pathlib import Path
import signal
import subprocess
import sys
import time

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import adopt_orphans, descendants_ended
from husky_runtime.domains import OwnDomain
from husky_runtime.shared_memory import clean_shared_memory, unused_files
from playpen_testing.shared_memory import mapped_by
import psutil
import pytest
import rclpy

RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'

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
NOHUP = """
import os, sys
from husky_runtime.supervise import run_to_end
hang_up = 'import os, signal, time; os.kill(os.getppid(), signal.SIGHUP); '
hang_up += 'time.sleep(0.5); print("goes on")'
sys.exit(run_to_end([sys.executable, '-c', hang_up], os.environ))
"""
PARTICIPANT = """
import sys, rclpy
rclpy.init()
node = rclpy.create_node('participant')
print('here', flush=True)
sys.stdin.read()
"""


def wait_for(fact: Callable[[], object], what: str) -> None:
    deadline = time.monotonic() + 10.0
    while not fact():
        assert time.monotonic() < deadline, f'not within 10 s: {what}'
        time.sleep(0.01)


def start(text: str, log: Path) -> ChildProcess:
    with log.open('w') as stream:
        process = ChildProcess([sys.executable, '-c', text], os.environ, stream)
    wait_for(lambda: log.read_text().endswith('\n'), 'the first line of the child')
    return process


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
    process.end(signal.SIGTERM)
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
    wait_for(lambda: not is_running(child), 'the end of the child')


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
    wait_for(lambda: not is_running(child), 'the end of the child')


def test_a_daemon_that_lost_its_mark_ends_too(tmp_path: Path) -> None:
    log = tmp_path / 'log'
    with descendants_ended():
        with log.open('w') as stream:
            command = ['env', '-i', sys.executable, '-c', DAEMON]
            child = ChildProcess(command, os.environ, stream)
        wait_for(lambda: log.read_text().endswith('\n'), 'the daemon')
        daemon = int(log.read_text())
        child.end()
        assert is_running(daemon), 'it has no mark'
    assert not is_running(daemon)


def test_under_nohup_a_run_outlives_its_terminal(tmp_path: Path) -> None:
    for prefix, said, status in ([], '', 128 + signal.SIGHUP), (['nohup'], 'goes on\n', 0):
        run = subprocess.run(
            [*prefix, sys.executable, '-c', NOHUP],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=20.0,
        )
        assert (run.stdout, run.returncode) == (said, status), run.stderr


def test_the_shared_memory_of_the_dead_goes() -> None:
    with OwnDomain() as one, OwnDomain() as another:
        dead, alive = participant(one.number), participant(another.number)
        files = {process: mapped_by([process.pid]) for process in (dead, alive)}
        # No other DDS puts messages into shared memory.
        used = rclpy.get_rmw_implementation_identifier() == 'rmw_fastrtps_cpp'
        assert [bool(names) for names in files.values()] == [used, used]
        dead.kill()
        dead.communicate()
        clean_shared_memory()
        left = {process: [f for f in names if f.exists()] for process, names in files.items()}
        unused = set(unused_files())
        alive.communicate(b'', timeout=10.0)
    # The ports of the dead are free: a participant that began meanwhile may have taken one.
    assert unused & set(left[dead]) == set()
    assert len(left[dead]) < len(files[dead]) or not used
    assert left[alive] == list(files[alive])


def test_shared_memory_that_others_may_use_stays() -> None:
    # Root without rights cannot see what root with rights has mapped.
    fewer = ['setpriv', '--bounding-set=-all', '--inh-caps=-all'] if os.geteuid() == 0 else []
    clean = 'from husky_runtime.shared_memory import clean_shared_memory as c; c()'
    with OwnDomain() as domain:
        alive = participant(domain.number)
        files = mapped_by([alive.pid])
        done = subprocess.run([*fewer, sys.executable, '-c', clean], env=os.environ)
        left = [file for file in files if file.exists()]
        alive.communicate(b'', timeout=10.0)
    assert (done.returncode, left) == (0, list(files))


def test_shared_memory_that_is_being_made_stays() -> None:
    file = Path(f'/dev/shm/fastrtps_made_by_{os.getpid()}_el')
    try:
        with file.open('w') as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            os.utime(file, (0.0, 0.0))
            clean_shared_memory()
            assert file.exists()
        clean_shared_memory()
        assert not file.exists()
    finally:
        file.unlink(missing_ok=True)


def test_a_port_that_is_taken_while_maps_are_read_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Its name is that of a dead one's port, whose files are used again; no node has this one.
    monkeypatch.setattr('husky_runtime.shared_memory._FOLDER', tmp_path)
    names = ('fastrtps_port99999', 'fastrtps_port99999_el', 'sem.fastrtps_port99999_mutex')
    for name in names:
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (0.0, 0.0))
    with (tmp_path / names[1]).open('w') as lock:

        def taken(_process: Path) -> str:
            fcntl.flock(lock, fcntl.LOCK_EX)
            (tmp_path / names[0]).unlink(missing_ok=True)
            (tmp_path / names[0]).touch()
            return ''

        with monkeypatch.context() as patched:
            patched.setattr('husky_runtime.shared_memory._maps_of', taken)
            clean_shared_memory()
        assert {file.name for file in tmp_path.iterdir()} == set(names)
    clean_shared_memory()
    assert not list(tmp_path.iterdir())


def test_a_clock_that_was_set_back_holds_nobody_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Not in /dev/shm: a run of somebody else would see it.
    monkeypatch.setattr('husky_runtime.shared_memory._FOLDER', tmp_path)
    file = tmp_path / 'fastrtps_left_from_the_future'
    file.touch()
    os.utime(file, (time.time() + 5.0,) * 2)
    begun = time.monotonic()
    clean_shared_memory()
    assert time.monotonic() - begun < 4.0
    assert not file.exists()


def participant(domain: int) -> 'subprocess.Popen[bytes]':
    """Start a node in a domain, and wait until it is there."""
    environment = {**os.environ, 'ROS_DOMAIN_ID': str(domain), RANGE: 'LOCALHOST'}
    command = [sys.executable, '-c', PARTICIPANT]
    started = subprocess.Popen(
        command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert started.stdout is not None
    # Before it, Fast DDS may tell of a port that another node took at the same time.
    assert b'here\n' in iter(started.stdout.readline, b''), 'it ended before its node was there'
    return started
