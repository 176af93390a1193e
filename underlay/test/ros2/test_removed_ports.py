# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A node that is killed leaves its port in shared memory; the one that takes it hears all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import ctypes
import mmap
import os
from pathlib import Path
import re
import signal
import struct
import subprocess
import sys
from typing import Any

from playpen_testing.waiting import wait_until
import pytest

FOLDER = Path('/dev/shm')
LIBRARY = Path(sys.prefix, 'lib', 'libremoved_ports.so')
# Of SharedMemGlobal::PortNode of Fast DDS 2.14, from its port_id on.
NODE = struct.Struct('<7I')
LISTENERS, LISTENER_SIZE, DOMAIN = 1024, 20, b'fastrtps\0'
IN_USE, WAITING = 1, 2
IS_OK, OTHER_FLAGS = 1, 6
SIZE, AT = 52400, 276  # of a port, and where its node is
MADE = struct.pack('<I', 2)  # what Boost begins memory with that is not still being made

Remove = Callable[[str], int]


def ports_of(process: subprocess.Popen[str]) -> list[Path]:
    """Return the ports where a process listens: it holds their locks."""
    held = {str(file.readlink()) for file in Path(f'/proc/{process.pid}/fd').iterdir()}
    locks = (name for name in held if re.fullmatch(r'/dev/shm/fastrtps_port\d+_el', name))
    return sorted(Path(lock.removesuffix('_el')) for lock in locks)


def is_mapped(process: subprocess.Popen[str], file: Path) -> bool:
    return f'{file}\n' in Path(f'/proc/{process.pid}/maps').read_text(encoding='utf-8')


def stop_between(process: subprocess.Popen[str], ports: list[Path]) -> None:
    """
    Stop a process, and make it look as if that was between its waits and their messages.

    It is there for microseconds.
    """
    places = [port.read_bytes().rindex(DOMAIN) - LISTENERS * LISTENER_SIZE for port in ports]

    def is_stopped() -> bool:
        process.send_signal(signal.SIGSTOP)
        os.waitid(os.P_PID, process.pid, os.WSTOPPED)
        states = [port.read_bytes()[place] for port, place in zip(ports, places, strict=True)]
        if all(state == IN_USE | WAITING for state in states):
            return True
        process.send_signal(signal.SIGCONT)
        return False

    wait_until(is_stopped, timeout_sec=20.0, what='listeners that wait')
    for port, place in zip(ports, places, strict=True):
        with port.open('r+b') as memory:
            memory.seek(place)
            memory.write(bytes([IN_USE]))


def test_who_takes_the_port_of_a_killed_node_hears_those_that_run(
    processes: Any, ros2: Any
) -> None:
    talker = processes.node('talker', 'talker')
    killed = processes.node('listener', 'killed')
    assert killed.stdout is not None
    assert 'heard' in killed.stdout.readline()
    ports = [port for port in ports_of(killed) if is_mapped(talker, port)]
    assert ports
    stop_between(killed, ports)
    killed.kill()
    killed.wait()
    answer = ros2('topic', 'echo', '--once', '/chatter', 'std_msgs/msg/String')
    assert 'data: hello' in answer.out


@pytest.fixture(name='number')
def free_number() -> Iterator[int]:
    """Return the number of a port that no domain has."""
    number = 100_000 + os.getpid()
    yield number
    for file in FOLDER.glob(f'fastrtps_port{number}*'):
        file.unlink()


@pytest.fixture(name='remove')
def load_remove() -> Remove:
    library = ctypes.CDLL(str(LIBRARY))
    return lambda name: int(library.mark_and_unlink(f'/{name}'.encode()))


class Port:
    """A file in shared memory that tells of a port, mapped."""

    def __init__(
        self, number: int, *, suffix: str = '', size: int = SIZE, check_ms: int = 1000
    ) -> None:
        node = NODE.pack(number, 1, check_ms, 333, 512, 1, IS_OK | OTHER_FLAGS)
        self.file = FOLDER / f'fastrtps_port{number}{suffix}'
        self.written = (MADE.ljust(AT, b'\0') + node).ljust(size, b'\0')
        self.file.write_bytes(self.written)
        with self.file.open('r+b') as file:
            self.memory = mmap.mmap(file.fileno(), size)


def test_a_port_is_marked_before_it_is_removed(number: int, remove: Remove) -> None:
    port = Port(number)
    assert remove(port.file.name) == 0
    assert not port.file.exists()
    marked = port.written[: AT + NODE.size - 4] + struct.pack('<I', OTHER_FLAGS)
    assert port.memory[:] == marked.ljust(SIZE, b'\0')
    assert remove(port.file.name) == -1


@pytest.mark.parametrize(
    'what',
    [
        {'suffix': '_el'},
        {'suffix': '0'},  # another number than it tells of
        {'size': 4095},
        {'check_ms': 0},
        {'check_ms': 2000},
    ],
    ids=str,
)
def test_what_is_no_port_is_removed_as_it_is(
    number: int, remove: Remove, what: dict[str, Any]
) -> None:
    other = Port(number, **what)
    assert remove(other.file.name) == 0
    assert not other.file.exists()
    assert other.memory[:] == other.written


def test_a_link_is_not_followed(number: int, remove: Remove) -> None:
    port = Port(number)
    link = FOLDER / f'{port.file.name}0'
    link.symlink_to(port.file)
    assert remove(link.name) == 0
    assert not link.is_symlink()
    assert port.memory[:] == port.written
