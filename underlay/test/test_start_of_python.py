# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What every Python of the virtual environment does at its start, and what it does not."""

import os
from pathlib import Path
import subprocess
import sys
import sysconfig

SITE = Path(sysconfig.get_path('purelib'))


def run(*options: str, environment: dict[str, str] | None = None) -> str:
    command = [sys.executable, *options]
    return subprocess.run(
        command, env=environment, check=True, capture_output=True, text=True, timeout=30.0
    ).stdout


def test_to_take_interrupts_loads_nothing_else() -> None:
    program = f"""
import os, sys, time
sys.path.append({str(SITE)!r})
before = set(sys.modules)
import interrupt_while_loading
print(*set(sys.modules) - before)
"""
    assert run('-S', '-c', program).split() == ['interrupt_while_loading']
