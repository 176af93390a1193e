# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Run a command as a user that nobody else is, and end with it all that this user has made.

A program, `python -I -S -W ignore guard.py USER LIFELINE COMMAND...`, that imports nothing of
ours: it has to start quickly. It does what a process namespace does where there is none. LIFELINE
is a pipe that ends with the grader, for inside.py too. The command takes the user's number by
itself; the guard stays root, whom that user cannot signal.
"""

import _thread
from collections.abc import Callable
import contextlib
import ctypes
import os
import select
import sys

_LIBC = ctypes.CDLL(None)
_PR_SET_PDEATHSIG, _PR_SET_CHILD_SUBREAPER = 1, 36  # <linux/prctl.h>
_SIGINT, _SIGKILL, _SIGTERM = 2, 9, 15  # <signal.h>; to import signal takes long
_SIG_IGN = ctypes.c_void_p(1)
_UNSEEN = 1 << 20  # from a jail's user to the one that acts for it, which it cannot signal
_IPC_RMID = 0  # <linux/ipc.h>


def _start(command: list[str]) -> int:
    child = os.fork()
    if child == 0:
        # So all that the command starts stays below it, whatever becomes of the parents.
        _LIBC.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        os.execv(command[0], command)
    return child


def _kill_without_grader(child: int, lifeline: int) -> None:
    end = select.poll()
    end.register(lifeline, 0)  # reports POLLHUP, unasked, when nobody can write any more
    end.poll()
    os.kill(child, _SIGKILL)


def _end_all(user: int) -> None:
    """
    Kill every process of a user, and wait for their end.

    The kernel does it in one go (kill(2) to -1), which no fork escapes: a signal to one after the
    other would never come to an end with programs that multiply.
    """

    def kill() -> None:
        with contextlib.suppress(OSError):  # there are none
            os.kill(-1, _SIGKILL)

    _act_as(user, kill)


def _remove_ipc(user: int) -> None:
    """
    Remove what a user has left of System V's shared memory, semaphores and message queues.

    See sysvipc(7). It has to be done as that user: root in a container may not.
    """
    removals = {
        'shm': lambda number: _LIBC.shmctl(number, _IPC_RMID, None),
        'sem': lambda number: _LIBC.semctl(number, 0, _IPC_RMID),
        'msg': lambda number: _LIBC.msgctl(number, _IPC_RMID, None),
    }

    def remove() -> None:
        for kind, removal in removals.items():
            with (
                contextlib.suppress(FileNotFoundError),  # a kernel without them
                open(f'/proc/sysvipc/{kind}') as table,  # noqa: PTH123  # its import takes long
            ):
                names, *rows = [line.split() for line in table]
                for row in rows:
                    entry = dict(zip(names, row, strict=True))
                    if str(user) in (entry['uid'], entry['cuid']):
                        removal(int(row[1]))

    _act_as(user, remove)


def _act_as(user: int, act: Callable[[], None]) -> None:
    """Do something as a user whose processes cannot signal who does it; wait for all children."""
    if os.fork() == 0:
        os.setgroups([])
        unseen = user + _UNSEEN
        os.setresuid(unseen, user, unseen)
        try:
            act()
        finally:
            os._exit(0)
    with contextlib.suppress(ChildProcessError):
        while True:
            os.wait()


def main(user: int, lifeline: int, command: list[str]) -> int:
    """Run the command to its end, or to that of the grader; return its exit code."""
    # Not with the grader: then nobody would end the others.
    _LIBC.prctl(_PR_SET_PDEATHSIG, 0, 0, 0, 0)
    _LIBC.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    for number in (_SIGINT, _SIGTERM):  # these are for the command
        _LIBC.signal(number, _SIG_IGN)
    child = _start(command)
    _thread.start_new_thread(_kill_without_grader, (child, lifeline))
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    _end_all(user)
    _remove_ipc(user)
    return code if code >= 0 else 128 - code


if __name__ == '__main__':
    exit_code = main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])
    os._exit(exit_code)  # without the time that Python takes to tidy up
