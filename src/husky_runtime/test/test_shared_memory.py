# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What killed nodes leave in shared memory goes, and nothing that a node has or takes."""

from contextlib import suppress
import fcntl
import os
from pathlib import Path
import subprocess
import sys
import time

from husky_runtime.domains import Lock, OwnDomain
from husky_runtime.shared_memory import clean_shared_memory, unused_files, wait_for_lock
from husky_runtime.shared_memory_ports import FOLDER, Mutex, PORT
from playpen_testing.shared_memory import Files, lost, mapped_by
from playpen_testing.waiting import wait_until
import psutil
import pytest

PARTICIPANT = """
import sys, rclpy
rclpy.init()
node = rclpy.create_node('participant')
print('here', flush=True)
sys.stdin.read()
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Put a folder in the place of /dev/shm, of which a run of somebody else knows nothing."""
    for module in ('shared_memory', 'shared_memory_ports'):
        monkeypatch.setattr(f'husky_runtime.{module}.FOLDER', tmp_path)
    return tmp_path


def test_the_shared_memory_of_the_dead_goes() -> None:
    with OwnDomain() as one, OwnDomain() as another:
        dead, alive = participant(one.number), participant(another.number)
        files = {process: mapped_by([process.pid]) for process in (dead, alive)}
        assert all(files.values())
        dead.kill()
        dead.communicate()
        clean_shared_memory()
        left = {process: [f for f in names if f.exists()] for process, names in files.items()}
        # The ports of the dead are free: a participant that began meanwhile may have taken one,
        # and for a moment not have mapped it yet, or no longer.
        wait_until(
            lambda: set(unused_files()).isdisjoint(left[dead]),
            timeout_sec=5.0,
            what=lambda: f'the end of {set(unused_files()).intersection(left[dead])}',
        )
        alive.communicate(b'', timeout=10.0)
    assert len(left[dead]) < len(files[dead])
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
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Its name is that of a dead one's port, whose files are used again; no node has this one.
    names = ('fastrtps_port99999', 'fastrtps_port99999_el', 'sem.fastrtps_port99999_mutex')
    for name in names:
        (folder / name).touch()
        os.utime(folder / name, (0.0, 0.0))
    with (folder / names[1]).open('w') as lock:

        def taken(_process: Path) -> str:
            fcntl.flock(lock, fcntl.LOCK_EX)
            (folder / names[0]).unlink(missing_ok=True)
            (folder / names[0]).touch()
            return ''

        with monkeypatch.context() as patched:
            patched.setattr('husky_runtime.shared_memory._maps_of', taken)
            clean_shared_memory()
        assert {file.name for file in folder.iterdir()} == set(names)
    clean_shared_memory()
    assert not list(folder.iterdir())


def test_a_clock_that_was_set_back_holds_nobody_up(folder: Path) -> None:
    file = folder / 'fastrtps_left_from_the_future'
    file.touch()
    os.utime(file, (time.time() + 5.0,) * 2)
    begun = time.monotonic()
    clean_shared_memory()
    assert time.monotonic() - begun < 4.0
    assert not file.exists()


@pytest.mark.parametrize('mutex', ['is there', 'is gone'])
@pytest.mark.parametrize('look', [1, 2])
def test_a_port_of_the_dead_that_a_node_takes_after_a_look_stays(
    look: int, mutex: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks = list[bool]()
    begun = list[Process]()
    with OwnDomain() as domain:
        dead = participant(domain.number)
        port = port_of(domain.number)
        assert port in mapped_by([dead.pid])
        locks = [no_other_clean_up()]  # it would remove what the dead leaves
        dead.kill()
        dead.communicate()
        if mutex == 'is gone':
            Mutex(port.name).file.unlink()
        for file in FOLDER.glob(f'*{port.name}*'):
            os.utime(file, (0.0, 0.0))  # what is as old is not being made

        def look_before_it_is_taken() -> dict[Path, float]:
            found = unused_files()
            looks.append(port in found)
            if len(looks) == look:
                begun.append(begin(domain.number))
                # After the last look it waits for the mutex, before that it gets the port.
                sought = port if look == 1 else Mutex(port.name).file
                wait_until(
                    lambda: sought in mapped_by([begun[0].pid]),
                    timeout_sec=20.0,
                    what=lambda: f'a node that has {sought} of {mapped_by([begun[0].pid])}',
                )
            return found

        def lock() -> Lock:
            return locks.pop() if locks else wait_for_lock()

        monkeypatch.setattr('husky_runtime.shared_memory.wait_for_lock', lock)
        monkeypatch.setattr('husky_runtime.shared_memory.unused_files', look_before_it_is_taken)
        clean_shared_memory()
        (alive,) = begun
        wait_for_node(alive)
        has: Files = {
            file: inode for file, inode in mapped_by([alive.pid]).items() if file == port
        }
        gone = lost(has)
        alive.communicate(b'', timeout=10.0)
    assert looks[:look] == [True] * look, 'the dead left nothing'
    assert (list(has), gone) == ([port], [])


@pytest.mark.parametrize('size', [0, 52400])
def test_a_node_goes_on_where_one_was_killed_while_it_made_the_port(size: int) -> None:
    with OwnDomain() as domain:
        port = port_of(domain.number)
        clean_shared_memory()
        port.write_bytes(bytes(size))
        os.utime(port, (time.time() + 1000.0,) * 2)  # no other clean-up takes it for left
        lock = Path(f'{port}_el')
        with lock.open('w') as held:
            fcntl.flock(held, fcntl.LOCK_EX)
            node = begin(domain.number)
            wait_until(
                lambda: port in open_files(node.pid),
                timeout_sec=20.0,
                what=lambda: f'a node that waits for its port in {open_files(node.pid)}',
            )
            lock.unlink()
        os.utime(port, (time.time() - 10.0,) * 2)
        clean_shared_memory()
        try:
            said, _ = node.communicate(b'', timeout=20.0)
        finally:
            node.kill()
        assert said.endswith(b'here\n')
        clean_shared_memory()
        assert not port.exists()


def test_a_port_goes_whose_name_begins_that_of_another(folder: Path) -> None:
    with OwnDomain() as domain:
        alive = participant(domain.number)
        port = port_of(domain.number)
        assert port in mapped_by([alive.pid])
        left = folder / port.name[:-1]
        left.touch()
        os.utime(left, (0.0, 0.0))
        clean_shared_memory()
        alive.communicate(b'', timeout=10.0)
    assert not left.exists()


def test_what_only_looks_like_a_port_is_no_trap(folder: Path) -> None:
    mine = folder / 'mine'
    mine.write_bytes(bytes(100))
    os.utime(mine, (0.0, 0.0))
    (folder / f'{PORT}1').symlink_to(mine)
    (folder / f'{PORT}2').write_bytes(b'\0')
    os.mkfifo(folder / f'{PORT}3')
    (folder / f'sem.{PORT}4_mutex').touch()
    (folder / f'sem.{PORT}5_mutex').symlink_to(mine)
    for file in folder.iterdir():
        os.utime(file, (0.0, 0.0), follow_symlinks=False)
    clean_shared_memory()
    assert mine.read_bytes() == bytes(100)
    assert list(folder.iterdir()) == [mine]


Process = subprocess.Popen[bytes]


def no_other_clean_up() -> Lock:
    """Wait for a moment without one, of whatever else runs on the machine, and keep it so."""
    locks = list[Lock]()

    def is_taken() -> bool:
        with suppress(BlockingIOError):
            locks.append(wait_for_lock())
        return bool(locks)

    wait_until(is_taken, timeout_sec=60.0, what='a moment without a clean-up')
    return locks[0]


def port_of(domain: int) -> Path:
    """Return the port of the first participant of a domain: OMG DDSI-RTPS 2.2, 9.6.1.1."""
    return FOLDER / f'{PORT}{7400 + 250 * domain + 11}'


def open_files(pid: int) -> set[Path]:
    return {Path(file.path) for file in psutil.Process(pid).open_files()}


@pytest.mark.parametrize(
    ('middleware', 'looks'),
    [('rmw_fastrtps_cpp', True), ('', True), ('rmw_cyclonedds_cpp', False)],
)
def test_too_little_is_refused_where_fast_dds_is_used(middleware: str, *, looks: bool) -> None:
    small = 'mount -t tmpfs -o size=1300k tmpfs /dev/shm && exec "$0" -c "$1"'
    check = 'from husky_runtime.shared_memory import check_shared_memory as check; check()'
    done = subprocess.run(
        ['unshare', '--map-root-user', '--mount', 'bash', '-c', small, sys.executable, check],
        env={**os.environ, 'RMW_IMPLEMENTATION': middleware},
        capture_output=True,
        text=True,
    )
    assert ('/dev/shm has less than 4 MB left' in done.stderr) == looks, done
    assert (done.returncode == 0) != looks, done


def participant(domain: int) -> Process:
    """Start a node in a domain, and wait until it is there."""
    started = begin(domain)
    wait_for_node(started)
    return started


def begin(domain: int) -> Process:
    """Start a node of Fast DDS: no other DDS puts messages into shared memory."""
    environment = {
        **os.environ,
        'RMW_IMPLEMENTATION': 'rmw_fastrtps_cpp',
        'ROS_DOMAIN_ID': str(domain),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
    }
    command = [sys.executable, '-c', PARTICIPANT]
    return subprocess.Popen(
        command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )


def wait_for_node(started: Process) -> None:
    assert started.stdout is not None
    # Before it, Fast DDS may tell of a port that another node took at the same time.
    assert b'here\n' in iter(started.stdout.readline, b''), 'it ended before its node was there'
