# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When real processes are at rest."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
import sys

from husky_grader.run.rest import Resting, tell_first
from husky_runtime.children import ChildProcess
from playpen_testing.waiting import wait_until
import pytest

WAITS = 'import threading; print(1, flush=True); threading.Event().wait()'
BUSY = 'print(1, flush=True)\nwhile True: pass'
BUSY_THREAD = f'import threading; threading.Thread(target=exec, args=({BUSY!r},)).start()'
BUSY_CHILD = f'import subprocess, sys; subprocess.run([sys.executable, "-c", {BUSY!r}])'


@contextmanager
def controller(program: str, folder: Path) -> Iterator[Resting]:
    """Run a program that has printed something."""
    log, first = folder / 'log', folder / 'first'
    with log.open('w') as output:
        child = ChildProcess([sys.executable, '-c', program], os.environ, output)
    with child:
        wait_until(lambda: bool(log.read_text()), timeout_sec=30.0, what='a line of the program')
        tell_first(first, child.pid)
        yield Resting(first)


def test_a_program_that_waits_is_at_rest(tmp_path: Path) -> None:
    with controller(WAITS, tmp_path) as resting:
        wait_until(resting.at_rest, timeout_sec=30.0, what='rest')


@pytest.mark.parametrize('program', [BUSY, BUSY_THREAD, BUSY_CHILD], ids=['', 'thread', 'child'])
def test_a_program_that_computes_is_not_at_rest(tmp_path: Path, program: str) -> None:
    with controller(program, tmp_path) as resting:
        assert not any(resting.at_rest() for _ in range(100))


def test_who_has_not_started_or_has_ended_is_not_at_rest(tmp_path: Path) -> None:
    assert not Resting(tmp_path / 'first').at_rest()
    with controller(WAITS, tmp_path) as resting:
        pass
    assert not resting.at_rest()
