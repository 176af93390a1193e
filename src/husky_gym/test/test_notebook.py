# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The notebook runs from its first cell to its last, and what it trains learns."""

import json
import os
from pathlib import Path
import re
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[3]
NOTEBOOK = json.loads((ROOT / 'docs' / 'learning.ipynb').read_text(encoding='utf-8'))
CODE = [cell for cell in NOTEBOOK['cells'] if cell['cell_type'] == 'code']


def test_no_output_is_kept() -> None:
    assert [cell for cell in CODE if cell['outputs'] or cell['execution_count']] == []


@pytest.mark.timeout(120)
def test_the_notebook_trains_a_policy_that_is_better(tmp_path: Path) -> None:
    # As in a notebook, its code is in no file that the processes of async could import.
    done = subprocess.run(
        [sys.executable, '-W', 'error', '-c', 'import sys; exec(sys.stdin.read())'],
        input='\n'.join(''.join(cell['source']) for cell in CODE),
        cwd=tmp_path,
        env={**os.environ, 'MPLBACKEND': 'Agg', 'HUSKY_TRAINING_SEC': '0.1'},
        capture_output=True,
        text=True,
        timeout=110.0,
    )
    assert done.returncode == 0, done.stderr
    assert 'score 100.0, the rewards add up to 100.0' in done.stdout
    result = re.search(r'^score before (\S+), after (\S+)$', done.stdout, re.M)
    assert result is not None, done.stdout
    before, after = map(float, result.groups())
    assert after > before + 10.0


def test_the_set_up_of_the_lab_installs_nothing_of_it() -> None:
    wanted = ''.join(
        (ROOT / 'requirements' / name).read_text()
        for name in ('ros.in', 'lab.in', 'without_rosdep.in')
    )
    assert 'gym' not in wanted
    assert 'gymnasium\n' in (ROOT / 'requirements' / 'gym.in').read_text()
