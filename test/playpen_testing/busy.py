# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A machine whose processors are kept by others."""

from collections.abc import Iterator
from contextlib import contextmanager
import subprocess


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
