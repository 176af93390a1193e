# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C in the first second of a command; every command and moment: benchmark/interrupts.py."""

from pathlib import Path
import subprocess
import sys

import pytest

SWEEP = Path(__file__).resolve().parent.parent / 'benchmark' / 'interrupts.py'


@pytest.mark.timeout(90)
@pytest.mark.parametrize('command', ['lab drive', 'lab test', 'lab grade', 'rqt_graph'])
def test_a_command_that_is_interrupted_at_once_ends_clean(command: str, domain_id: int) -> None:
    sweep = subprocess.run(
        [sys.executable, str(SWEEP), '--step', '0.25', command],
        capture_output=True,
        text=True,
        timeout=80.0,
        check=False,
    )
    assert sweep.returncode == 0, sweep.stdout + sweep.stderr
