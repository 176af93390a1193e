# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A program that would not be watched is watched all the same, and ends.

It may open its output once more, to read it, where the grader and the program are the same user,
as those of an ordinary one are; or have a name that is no word.
"""

from collections.abc import Sequence
import os
from pathlib import Path
import select
import subprocess
import sys
from types import SimpleNamespace
from typing import Any, BinaryIO

from husky_grader.jail import Jail, JailedProcess, Limits, Sandbox
from husky_grader.jail.sandbox import Call, Entry
from playpen_testing.jails import (
    as_ordinary_user,
    in_each_of_namespaces,
    in_each_sandbox,
    in_each_way_with_processes,
    running,
)
from playpen_testing.waiting import wait_until
import psutil
import pytest

GRADER = """
import sys
from pathlib import Path
from husky_grader.jail import find_sandbox, Jail
name, folder, mark, program = sys.argv[1:]
with Jail(find_sandbox(name), Path(folder)) as jail:
    jail.run([sys.executable, '-c', program, mark], log=Path(folder + '.log'), within_sec=600.0)
"""
READS = """
import os, time
try:
    reader = os.open('/proc/self/fd/1', os.O_RDONLY)
except PermissionError:
    print('cannot read', flush=True)
else:
    print('can read', flush=True)
time.sleep(600)
"""
EATS = """
import os, time
os.write(1, b'a word')
eaten = b'x' * 200_000_000
time.sleep(600)
"""

# A digit for str.isdigit, of which int makes no number.
NAMED = f"""
import ctypes
ctypes.CDLL(None).prctl(15, '\u00b2'.encode(), 0, 0, 0)  # PR_SET_NAME
{EATS}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'jail').mkdir()
    return tmp_path / 'jail'


def grader(sandbox: Sandbox, folder: Path) -> list[str]:
    """Return the command that runs a program in a jail; its mark is the folder."""
    return [sys.executable, '-c', GRADER, sandbox.name, str(folder), str(folder), READS]


def ends_with(command: Sequence[str], folder: Path) -> str:
    """Kill a grader once its program has said what it can; return that once it is gone too."""
    log, mark = folder.with_name('jail.log'), str(folder)
    with subprocess.Popen(command) as started:
        try:
            wait_until(
                lambda: log.is_file() and log.read_text().endswith(' read\n'),
                timeout_sec=20.0,
                what='what the program says',
            )
            assert len(running(mark)) >= 1
        finally:
            started.kill()
    wait_until(
        lambda: running(mark) == [], timeout_sec=4.0, what=lambda: f'the end of {running(mark)}'
    )
    return log.read_text()


@in_each_sandbox
def test_it_ends_with_a_killed_grader(sandbox: Sandbox, folder: Path) -> None:
    assert ends_with(grader(sandbox, folder), folder)


@in_each_of_namespaces
def test_it_ends_with_the_killed_grader_of_an_ordinary_user(
    sandbox: Sandbox, folder: Path
) -> None:
    said = ends_with(as_ordinary_user(grader(sandbox, folder)), folder)
    assert said == 'can read\n'


@in_each_way_with_processes
def test_its_limits_are_watched_whoever_reads_faster(
    sandbox: Sandbox, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stolen(readable: list[BinaryIO], *others: Any) -> Any:
        """Select, and take what there is to read before the grader does."""
        found = select.select(readable, *others)
        for file in found[0]:
            thief = os.open(f'/proc/self/fd/{file.fileno()}', os.O_RDONLY | os.O_NONBLOCK)
            with os.fdopen(thief, 'rb', buffering=0) as also_open:
                also_open.read(1000)
        return found

    monkeypatch.setattr('husky_grader.jail.process.select', SimpleNamespace(select=stolen))
    log = folder.with_name('log')
    with Jail(sandbox, folder, limits=Limits(memory_mb=150)) as jail:
        process = jail.start([sys.executable, '-c', EATS], log=log)
        assert process.wait(10.0)
    assert 'MB of memory; 150 MB are allowed' in process.stopped
    assert 'a word' not in log.read_text()


@in_each_way_with_processes
def test_its_limits_are_watched_whatever_its_name_is(sandbox: Sandbox, folder: Path) -> None:
    with Jail(sandbox, folder, limits=Limits(memory_mb=150)) as jail:
        process = jail.start([sys.executable, '-c', NAMED], log=folder.with_name('log'))
        assert process.wait(10.0)
    assert 'MB of memory; 150 MB are allowed' in process.stopped


def test_its_limits_are_watched_where_it_is_no_descendant(folder: Path) -> None:
    pid = folder / 'pid'

    def first(_: object) -> psutil.Process | None:
        return psutil.Process(int(pid.read_text())) if pid.exists() else None

    # As a container: who starts it waits beside it.
    writes = f'echo $$ >{pid}.part; mv {pid}.part {pid}; exec {sys.executable} -c "$0"'
    client = ['bash', '-c', 'setsid --fork sh -c "$1" "$2"; sleep 600', 'sh', writes, EATS]
    entry = Entry(client, os.environ, first, is_first_elsewhere=True)
    call = Call(client, {}, folder, (), Limits(memory_mb=150))
    cell: Any = SimpleNamespace(enter=lambda _: entry)
    with JailedProcess(cell, call, log=folder.with_name('log')) as process:
        wait_until(
            lambda: process.stopped != '',
            timeout_sec=10.0,
            what='the end of one that takes too much',
        )
    assert 'MB of memory; 150 MB are allowed' in process.stopped
