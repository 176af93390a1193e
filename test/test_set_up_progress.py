# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The line that tells how far a step of the set-up is."""

from importlib import metadata
from pathlib import Path
import re
import subprocess
import sys
import venv
import zipfile

from husky_runtime.set_up_progress import STEPS
from playpen_testing.processes import IN_A_TERMINAL, Processes
import pytest

ROOT = Path(__file__).resolve().parent.parent
PROGRESS = ROOT / 'src' / 'husky_runtime' / 'husky_runtime' / 'set_up_progress.py'


def wheel(folder: Path, name: str) -> None:
    """Write a package that has nothing in it."""
    about = f'{name}-1.0.dist-info'
    texts = {
        'METADATA': f'Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n',
        'WHEEL': 'Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n',
        'RECORD': ''.join(f'{about}/{file},,\n' for file in ('METADATA', 'WHEEL', 'RECORD')),
    }
    with zipfile.ZipFile(folder / f'{name}-1.0-py3-none-any.whl', 'w') as archive:
        for file, text in texts.items():
            archive.writestr(f'{about}/{file}', text)


@pytest.fixture
def pip(tmp_path: Path) -> list[str]:
    """Return a command that installs two packages, in an environment of its own, offline."""
    for name in ('one', 'another'):
        wheel(tmp_path, name)
    venv.create(tmp_path / 'venv')
    python = str(tmp_path / 'venv' / 'bin' / 'python')
    options = ('--no-index', '--find-links', str(tmp_path), '--no-compile')
    # Whoever imports pip gets no distutils of setuptools any more: here, the tests after this one.
    ours = f'import sys; sys.path.append({str(metadata.distribution("pip").locate_file(""))!r}); '
    run = ours + 'from runpy import run_module; run_module("pip", run_name="__main__")'
    return [python, '-c', run, 'install', *options, 'one', 'another']


def test_a_set_up_shows_a_bar_that_goes(
    processes: Processes, pip: list[str], tmp_path: Path
) -> None:
    command = [sys.executable, str(PROGRESS), 'pip', '2', str(tmp_path / 'log'), *pip]
    run = processes.start(sys.executable, '-c', IN_A_TERMINAL, *command)
    assert run.wait(timeout_sec=30.0) == 0, run.output
    # A pipe in text mode takes the beginning of the line for a new one.
    shown = [line.rstrip() for line in run.lines]
    assert 'lab: [........................] looking for packages' in shown
    assert shown[-1] == '', 'the line is empty again'
    assert 'Successfully installed another-1.0 one-1.0' in (tmp_path / 'log').read_text()


def test_a_set_up_that_fails_prints_nothing_more(pip: list[str], tmp_path: Path) -> None:
    command = [sys.executable, str(PROGRESS), 'pip', '2', str(tmp_path / 'log'), *pip, 'third']
    done = subprocess.run(command, capture_output=True, text=True, timeout=30)
    told = re.sub(r'lab: \d+%, .*\n', '', done.stderr)  # how far it is, every few seconds
    assert (done.returncode, done.stdout, told) == (1, '', '')
    assert 'No matching distribution found for third' in (tmp_path / 'log').read_text()


@pytest.mark.parametrize(
    ('kind', 'printed', 'shown', 'part'),
    [
        ('pip', ['Collecting numpy==2.4.6 (from -r requirements/lab.in)'], 'looking', 1 / 8),
        ('pip', ['  Downloading a.whl (3 kB)', 'Collecting a', 'Collecting A'], 'looking', 1 / 8),
        ('pip', ['  Downloading viser-1.3-py3.whl (9.5 MB)'], 'downloading viser (9.5 MB)', 0),
        ('pip', ['Installing collected packages: a, b'], 'installing 0 of 2 packages', 0.5),
        ('colcon', ['Starting >>> one', 'Starting >>> two'], 'building two', 0),
        ('colcon', ['Starting >>> one', 'Finished <<< one [1.2s]'], 'building one', 1 / 4),
    ],
)
def test_the_lines_of_a_step_tell_how_far_it_is(
    kind: str, printed: list[str], shown: str, part: float
) -> None:
    step = STEPS[kind](4, '/nowhere/bin/python')
    for line in printed:
        step.read(line)
    assert step.part() == part
    assert shown in step.doing
