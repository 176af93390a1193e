# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A machine whose processors are kept by others."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import subprocess
import time

from playpen_testing.waiting import wait_until


@contextmanager
def busy_machine(processes: int, *, nice: int = 0) -> Iterator[None]:
    """Let so many processes compute; at a niceness of 19 they want to, and hinder nobody."""
    command = ['nice', '-n', str(nice), 'sh', '-c', 'while :; do :; done']
    computing = [subprocess.Popen(command) for _ in range(processes)]
    try:
        yield
    finally:
        for process in computing:
            process.kill()
            process.wait()


def sec_to_the_end(pid: int, *, timeout_sec: float = 10.0) -> float:
    """
    Return how long a child takes to its end, without the time that others keep it waiting.

    It is not reaped.

    :raises AssertionError: if it has not ended within the timeout, on the clock.
    """
    began, waited_sec = time.monotonic(), _wait_for_a_processor_sec(pid)
    how = os.WEXITED | os.WNOHANG | os.WNOWAIT
    wait_until(
        lambda: os.waitid(os.P_PID, pid, how) is not None,
        timeout_sec=timeout_sec,
        what=f'the end of process {pid}',
    )
    waited_sec = _wait_for_a_processor_sec(pid) - waited_sec
    return time.monotonic() - began - waited_sec


def _wait_for_a_processor_sec(pid: int) -> float:
    """Return how long the first thread of a process could have run and did not."""
    try:
        return int(Path(f'/proc/{pid}/schedstat').read_text().split()[1]) * 1e-9
    except OSError:  # the kernel does not count it
        return 0.0
