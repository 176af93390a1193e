# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C at moments when Python itself would print and drop it, and go on."""

import os
from pathlib import Path
import signal
import subprocess
import sys

import pytest

SLEEP = """
import time
time.sleep(20.0)
print('never interrupted')
"""
# What is raised in the callback of a weak reference goes nowhere.
IN_A_CALLBACK = f"""
import os, signal, weakref

class Thing:
    pass

thing = Thing()
reference = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGINT))
del thing
{SLEEP}
"""
# Python looks whether its script is a zip file; what is raised there is printed, and it goes on.
AT_THE_SCRIPT = """
import os, signal, sys

def interrupt(frame, event, _):
    if event == 'call' and 'zipimport' in frame.f_code.co_filename:
        sys.setprofile(None)
        os.kill(os.getpid(), signal.SIGINT)

sys.setprofile(interrupt)
"""


def run(program: Path) -> tuple[int, str, str]:
    ended = subprocess.run(
        [sys.executable, str(program)],
        env={**os.environ, 'PYTHONPATH': str(program.parent)},
        capture_output=True,
        text=True,
        timeout=15.0,
        start_new_session=True,
    )
    return ended.returncode, ended.stdout, ended.stderr


def test_an_interrupt_in_a_callback_is_raised_after_it(tmp_path: Path) -> None:
    program = tmp_path / 'program.py'
    program.write_text(IN_A_CALLBACK)
    assert run(program) == (-signal.SIGINT, '', '')


@pytest.mark.parametrize('name', ['program', 'program.py'])
def test_an_interrupt_before_the_script_is_read_ends_python(tmp_path: Path, name: str) -> None:
    (tmp_path / 'sitecustomize.py').write_text(AT_THE_SCRIPT)
    program = tmp_path / name
    program.write_text(SLEEP)
    assert run(program) == (-signal.SIGINT, '', '')
