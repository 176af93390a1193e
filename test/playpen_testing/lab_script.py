# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`./lab` where nothing is set up."""

import os
from pathlib import Path
import shutil
import subprocess

ROOT = Path(__file__).resolve().parents[2]


def bare_clone(folder: Path) -> Path:
    """Make a folder with what the set-up reads of a fresh clone, and nothing set up."""
    folder.mkdir(parents=True)
    shutil.copy(ROOT / 'lab', folder)
    for name in ('requirements', 'underlay'):
        shutil.copytree(ROOT / name, folder / name, ignore=_not_read)
    programs = Path('src', 'husky_runtime', 'husky_runtime')
    (folder / programs).mkdir(parents=True)
    for name in ('parent_death.py', 'set_up_progress.py'):
        shutil.copy(ROOT / programs / name, folder / programs)
    return folder


def _not_read(folder: str, names: list[str]) -> list[str]:
    """Name what the set-up reads late or never: most modules, tests, what Python compiles."""
    path = Path(folder)
    makes_key = path.name in ('colcon_rosidl_python', 'rosidl_typesupport_python')
    modules = path.name if path.parent == ROOT / 'underlay' and not makes_key else ''
    return [name for name in names if name in (modules, 'test', '__pycache__')]


def plain_environment() -> dict[str, str]:
    """Return the environment of a terminal in which nothing of ROS or the lab is set up."""
    ours = ('ROS_', 'AMENT_', 'COLCON_', 'HUSKY_', '_ROS_', 'VIRTUAL_ENV', 'LD_LIBRARY', 'PYTHON')
    kept = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    venv = os.environ.get('VIRTUAL_ENV', '')
    folders = kept['PATH'].split(os.pathsep)
    kept['PATH'] = os.pathsep.join(
        folder for folder in folders if not (venv and folder.startswith(venv))
    )
    return kept


def lab(
    clone: Path, *words: str, called_from: str = '/', **environment: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(clone / 'lab'), *words],
        cwd=called_from,
        env={**plain_environment(), **environment},
        capture_output=True,
        text=True,
        timeout=100,
    )


def program(folder: Path, name: str, text: str) -> str:
    """Put a program into a folder and return a PATH on which it comes first."""
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(f'#!/bin/sh\n{text}\n')
    (folder / name).chmod(0o755)
    return f'{folder}{os.pathsep}{plain_environment()["PATH"]}'


def refused(done: subprocess.CompletedProcess[str], *words: str) -> None:
    """Hold that the last line printed says why and that the exit status is 2."""
    lines = done.stderr.splitlines()
    assert done.returncode == 2, done.stderr
    assert lines[-1].startswith('lab: ')
    assert [word for word in words if word not in lines[-1]] == [], done.stderr
    assert len(lines) <= 2, 'at most one line of progress and one of refusal'


def sourced(function: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Call functions of ./lab, which are not yet in the environment of the wheels."""
    return subprocess.run(
        ['bash', '-c', f'source "$0" help >/dev/null; venv=/no/venv; {function}', ROOT / 'lab'],
        env={**plain_environment(), **environment},
        capture_output=True,
        text=True,
    )
