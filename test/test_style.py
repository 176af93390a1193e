# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One look and checked types over every Python file."""

from pathlib import Path
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory

import pytest

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ['src', 'underlay', 'test', 'benchmark', 'docs', 'conftest.py']


MOST_BYTES = 400_000  # the largest picture of docs has 330 000


def tracked(*patterns: str) -> list[Path]:
    """List the files of the repository; without git, as in a zip, those that are not ignored."""
    with TemporaryDirectory() as empty:
        options = []
        if not (ROOT / '.git').exists():
            subprocess.run(['git', 'init', '--quiet', '--bare', empty], check=True)
            options = ['--others', '--exclude-standard']
        where = [f'--git-dir={empty}', f'--work-tree={ROOT}'] if options else []
        listed = subprocess.check_output(
            ['git', *where, 'ls-files', *options, *patterns], cwd=ROOT, text=True
        )
    return [ROOT / line for line in listed.splitlines()]


def python_files() -> list[Path]:
    return tracked('*.py')


@pytest.mark.parametrize('command', ['check', 'format --check'])
def test_ruff_finds_nothing(command: str) -> None:
    ruff = [sys.executable, '-m', 'ruff', *command.split(), '--no-cache', *FOLDERS]
    done = subprocess.run(ruff, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.timeout(300)
def test_mypy_strict_finds_nothing() -> None:
    # What it knows of files that have not changed is in .mypy_cache: a tenth of the time.
    mypy = [sys.executable, '-m', 'mypy']
    packages = [path.parent for path in sorted(ROOT.glob('src/*/package.xml'))]
    distributions = [path.parent for path in sorted(ROOT.glob('underlay/*/package.xml'))]
    sources = [path / path.name for path in (*distributions, *packages)]
    ours = [ROOT / 'underlay' / 'test', ROOT / 'test', ROOT / 'benchmark', *ROOT.glob('docs/*.py')]
    tests, *others = without_equal_names([path / 'test' for path in packages])
    launch_files = sorted(ROOT.glob('src/*/launch/*.py'))
    # Each call reads anew what was found out of the modules that are imported: few calls.
    for targets in ([*sources, *ours, *tests], *others, launch_files):
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
    origin, clone = tmp_path / 'origin', tmp_path / 'clone'
    origin.mkdir()
    for name in ('.gitattributes', 'lab'):
        shutil.copy(ROOT / name, origin)
    author = ['-c', 'user.name=A', '-c', 'user.email=a@b']
    for words in (['init'], ['add', '.'], [*author, 'commit', '--message=A script']):
        subprocess.run(['git', *words], cwd=origin, check=True, stdout=subprocess.DEVNULL)
    windows = ['--config', 'core.autocrlf=true']
    subprocess.run(['git', 'clone', '--quiet', *windows, origin, clone], check=True)
    assert b'\r\n' not in (clone / 'lab').read_bytes()


def test_the_repository_holds_no_archives_and_nothing_large() -> None:
    archives = tracked('*.whl', '*.zip', '*.gz', '*.xz', '*.bz2', '*.deb')
    large = [path for path in tracked() if path.is_file() and path.stat().st_size > MOST_BYTES]
    assert [*archives, *large] == []
