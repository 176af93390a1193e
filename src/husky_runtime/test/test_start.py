# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that can be interrupted at any moment."""

from pathlib import Path
import subprocess
import sys

INTERRUPTED = 130
# Python prints and forgets what is raised in such a callback.
FORGETFUL = """
import os, signal, time, weakref

class Thing:
    pass

def main():
    thing = Thing()
    reference = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGINT))
    del thing
    time.sleep(20.0)
    print('never interrupted')
    return 0
"""


def test_an_interrupt_in_a_weakref_callback_is_not_lost(tmp_path: Path) -> None:
    (tmp_path / 'forgetful.py').write_text(FORGETFUL)
    program = (
        'import sys; from forgetful import main; from husky_runtime.start import run; '
        f'sys.exit(run(lambda: main, interrupted={INTERRUPTED}, catches=True))'
    )
    ended = subprocess.run(
        [sys.executable, '-c', program],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=30.0,
        check=False,
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (INTERRUPTED, '', '')
