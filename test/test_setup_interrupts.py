# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""An interrupt of `./lab` comes through, whether it waits or sets up."""

import fcntl
from pathlib import Path
import signal
import subprocess
import sys

from playpen_testing.lab_script import bare_clone, lab, program, refused, sourced
from playpen_testing.processes import Processes
from playpen_testing.waiting import wait_until
from psutil import process_iter
import pytest


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    return bare_clone(tmp_path / 'clone')


# Makes the count of signals that wait, which /proc/PID/status tells, a digit longer and shorter.
COUNTS = """
import ctypes, re
libc, timer = ctypes.CDLL(None), ctypes.c_void_p()
make = lambda: libc.timer_create(1, None, ctypes.byref(timer))
count = lambda: int(re.search(r'SigQ:\\t(\\d+)', open('/proc/self/status').read())[1])
while not set(str(count())) == {'9'}:
    make()
print('counts', flush=True)
while True:
    make()
    libc.timer_delete(timer)
"""


def test_a_blocked_interrupt_is_seen_whatever_else_the_kernel_tells() -> None:
    look = 'for ((i = 0; i < 500; i++)); do interrupts_are_held || echo missed; done'
    with subprocess.Popen([sys.executable, '-c', COUNTS], stdout=subprocess.PIPE) as counting:
        assert counting.stdout is not None
        assert counting.stdout.readline() == b'counts\n'
        try:
            told = sourced(
                f'exec env --block-signal=INT bash -c \'. "$0" help >/dev/null; {look}\' "$0"'
            )
        finally:
            counting.kill()
    assert (told.stdout, told.stderr) == ('', '')


def test_interrupts_are_kept_by_the_kernel_but_in_a_set_up(clone: Path, tmp_path: Path) -> None:
    # Bash loses one of some hundred that come while it starts or ends a command. While it forks it
    # holds them back, too: it is looked at where it waits.
    masks = tmp_path / 'masks'
    folder = tmp_path / 'bin'
    look = f's=/proc/$PPID/status; until grep -q sleeping $s; do :; done; grep SigBlk $s >>{masks}'
    program(folder, 'sha256sum', f'{look}; exec cksum')
    path = program(folder, 'df', 'printf "h\\nfs 1 1 90000 1%% /\\n"')
    refused(lab(clone, 'exec', 'true', PATH=path), 'disk is full')
    blocked = [int(line.split()[1], 16) for line in masks.read_text().splitlines()]
    assert [bool(mask & 1 << signal.SIGINT - 1) for mask in blocked] == [True, False]


def test_an_interrupt_ends_the_wait_for_another_set_up(processes: Processes, clone: Path) -> None:
    with (clone / '.lab.lock').open('w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run = processes.start(str(clone / 'lab'), 'exec', 'true')
        wait_until(
            lambda: any(
                each.info == {'cmdline': ['flock', '9'], 'ppid': run.pid}
                for each in process_iter(['cmdline', 'ppid'])
            ),
            timeout_sec=20.0,
            what='./lab that waits for the lock',
        )
        run.signal(signal.SIGINT)
        assert run.wait(timeout_sec=2.0) == 128 + signal.SIGINT
    assert run.lines[-1:] == ['lab: interrupted']
