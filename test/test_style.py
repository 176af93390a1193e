# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One look and checked types over every Python file."""

from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ['src', 'underlay', 'test', 'benchmark']


MOST_BYTES = 400_000  # the largest picture of docs has 330 000


def tracked(*patterns: str) -> list[Path]:
    listed = subprocess.run(
        ['git', 'ls-files', *patterns], cwd=ROOT, check=True, capture_output=True, text=True
    )
    return [ROOT / line for line in listed.stdout.splitlines()]


def python_files() -> list[Path]:
    return tracked('*.py')


@pytest.mark.parametrize('command', ['check', 'format --check'])
def test_ruff_finds_nothing(command: str) -> None:
    ruff = [sys.executable, '-m', 'ruff', *command.split(), '--no-cache', *FOLDERS]
    done = subprocess.run(ruff, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.timeout(300)
def test_mypy_strict_finds_nothing() -> None:
    # What it knows of files that have not changed is in .mypy_cache: a sixth of the time.
    mypy = [sys.executable, '-m', 'mypy']
    packages = [path.parent for path in sorted(ROOT.glob('src/*/package.xml'))]
    distributions = [path.parent for path in sorted(ROOT.glob('underlay/*/package.xml'))]
    sources = [path / path.name for path in (*distributions, *packages)]
    tests = [ROOT / 'underlay' / 'test', *(path / 'test' for path in packages)]
    launch_files = sorted(ROOT.glob('src/*/launch/*.py'))
    ours = [ROOT / 'test', ROOT / 'benchmark']
    for targets in (sources, *without_equal_names(tests), ours, *([f] for f in launch_files)):
        command = [*mypy, *map(str, targets)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


def without_equal_names(folders: list[Path]) -> list[list[Path]]:
    """Put as many folders together as have no two modules of one name, as conftest is."""
    groups: list[list[Path]] = []
    for folder in folders:
        names = {path.name for path in folder.glob('*.py')}
        for group in groups:
            if not any(names & {path.name for path in other.glob('*.py')} for other in group):
                group.append(folder)
                break
        else:
            groups.append([folder])
    return groups


def test_every_file_names_its_licence() -> None:
    header = '# SPDX-License-Identifier: Apache-2.0'
    without = [str(path) for path in python_files() if header not in path.read_text()[:200]]
    assert without == []


def test_no_module_is_longer_than_500_lines() -> None:
    long = [str(path) for path in python_files() if len(path.read_text().splitlines()) > 500]
    assert long == []


def test_a_script_in_a_clone_by_git_of_windows_has_no_line_ends_of_windows(tmp_path: Path) -> None:
    clone = ['git', 'clone', '--quiet', '--config', 'core.autocrlf=true', str(ROOT), str(tmp_path)]
    subprocess.run(clone, check=True)
    files = [path for path in tmp_path.rglob('*') if path.is_file()]
    scripts = [path for path in files if path.read_bytes().startswith(b'#!')]
    assert tmp_path / 'lab' in scripts
    assert [path for path in scripts if b'\r\n' in path.read_bytes()] == []


def test_the_repository_holds_no_archives_and_nothing_large() -> None:
    archives = tracked('*.whl', '*.zip', '*.gz', '*.xz', '*.bz2', '*.deb')
    large = [path for path in tracked() if path.is_file() and path.stat().st_size > MOST_BYTES]
    assert [*archives, *large] == []
