# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Ports of Fast DDS in shared memory: their mutexes, and those that nobody can open.

A port is a boost::interprocess::managed_shared_memory. A process that opens one takes its mutex,
and waits without end until who makes it has done so: one that was killed meanwhile never has, and
every node that would have the port after it hangs, deaf to Ctrl-C.
"""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
import ctypes
from io import FileIO
import os
from pathlib import Path
import struct
import time

FOLDER = Path('/dev/shm')
PORT = 'fastrtps_port'

# The first word of a port: <boost/interprocess/detail/managed_open_or_create_impl.hpp>.
_STATE = struct.Struct('@I')
_UNINITIALIZED, _INITIALIZING, _CORRUPTED = 0, 1, 3
_MAKING_SEC = 2.0  # it takes less than 1 ms; after as long Fast DDS gives up a mutex

_LIBC = ctypes.CDLL(None)
_LIBC.sem_open.restype = ctypes.c_void_p


def free_half_made_ports() -> None:
    """Remove ports of this user whose maker was killed meanwhile, and wake who waits for them."""
    for file in FOLDER.glob(f'{PORT}*[0-9]'):
        with suppress(OSError), open(file, 'r+b', buffering=0, opener=_open_here) as port:
            if _is_half_made(port):
                _free(file, port)


def _open_here(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_NOFOLLOW)  # anybody may have put a link there


def _is_half_made(port: FileIO) -> bool:
    status = os.fstat(port.fileno())
    if status.st_uid != os.getuid() or time.time() - status.st_mtime < _MAKING_SEC:
        return False
    (state,) = _STATE.unpack(os.pread(port.fileno(), _STATE.size, 0).ljust(_STATE.size, b'\0'))
    return state in (_UNINITIALIZED, _INITIALIZING)


def _free(file: Path, port: FileIO) -> None:
    """
    Remove a half-made port, and let those go on who wait for it: they make another one.

    :raises OSError: if it is gone already.
    """
    mutex = Mutex(file.name)
    # Where it is not free, who waits for the port has it, or somebody who was killed, too.
    is_taken = mutex.take()
    try:
        if os.path.samestat(file.stat(), os.fstat(port.fileno())):
            file.unlink()
        port.write(_STATE.pack(_CORRUPTED))
    finally:
        if is_taken:
            mutex.release()


class Mutex:
    """The mutex of a port, as sem_overview(7) has it; `file` is its file."""

    def __init__(self, port: str) -> None:
        self.file = FOLDER / f'sem.{port}_mutex'

    def take(self) -> bool:
        """Take it, made where there is none; returns whether it was free."""
        with self._semaphore(0 if self.file.exists() else os.O_CREAT) as semaphore:
            if not semaphore or _LIBC.sem_trywait(semaphore) != 0:
                return False
        with suppress(OSError):
            # One that was made here is none that a node is making.
            os.utime(self.file, (0.0, 0.0), follow_symlinks=False)
        # It is closed and stays taken: open ones are those of processes that want the port.
        return True

    def release(self) -> None:
        """Let others have it, if they did not give it up meanwhile and have made another one."""
        with self._semaphore() as semaphore:
            if semaphore:
                _LIBC.sem_post(semaphore)

    @contextmanager
    def _semaphore(self, flags: int = 0) -> Iterator[ctypes.c_void_p]:
        """Open it; null if there is none, or it is somebody else's."""
        name = f'/{self.file.name.removeprefix("sem.")}'.encode()
        is_one = flags or _is_whole(self.file)
        semaphore = ctypes.c_void_p(_LIBC.sem_open(name, flags, 0o644, 1) if is_one else None)
        try:
            yield semaphore
        finally:
            if semaphore:
                _LIBC.sem_close(semaphore)


def _is_whole(mutex: Path) -> bool:
    """Tell whether it is this user's, and can be read: the kernel ends who reads an empty one."""
    try:
        status = mutex.lstat()
    except OSError:
        return False
    return status.st_uid == os.getuid() and status.st_size > 0
