# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The steps of the lab that can be judged by looking at files: workspace, packages, build."""

import os
from pathlib import Path
import re
import signal
from tempfile import TemporaryFile
import xml.etree.ElementTree as ElementTree

from husky_runtime.children import ChildProcess
from husky_runtime.descendants import descendants_ended

BUILD_WITHIN_SEC = 300.0
SOURCE_WITHIN_SEC = 60.0
WORKSPACE_NAME = re.compile(r'CSE461[_ -]?\d+[_ -]\d+')
DEPENDENCIES = {'topic_demo': ('rclpy', 'std_msgs')}
DRIVING = ('rclpy', 'geometry_msgs')


Verdict = tuple[float, str]
"""How much of a step's points it gets, in percent, and why."""


class ProgramMissing(ValueError):
    """There is no such executable; the message says what there is."""


def workspace_step(workspace: Path) -> Verdict:
    """Look at the workspace's name and its src folder."""
    if not (workspace / 'src').is_dir():
        return 0.0, f'{workspace} has no folder src; packages live in it'
    if not WORKSPACE_NAME.fullmatch(workspace.name):
        return 50.0, f'named {workspace.name}; the sheet asks for CSE461_<section>_<group>'
    return 100.0, f'{workspace.name} with a folder src'


def package_step(workspace: Path, package: str) -> Verdict:
    """Look at a package's manifest."""
    packages = _packages(workspace)
    if package not in packages:
        have = ', '.join(sorted(packages)) or 'none'
        return 0.0, f'not in {workspace / "src"}; packages there: {have}'
    root = ElementTree.parse(packages[package] / 'package.xml').getroot()
    given = {element.text for element in root if element.tag.endswith('depend')}
    missing = [wanted for wanted in DEPENDENCIES.get(package, DRIVING) if wanted not in given]
    if missing:
        lines = ' '.join(f'<exec_depend>{wanted}</exec_depend>' for wanted in missing)
        return 50.0, f'package.xml lacks: {lines}'
    if root.findtext('export/build_type') != 'ament_python':
        return 50.0, 'package.xml lacks <export><build_type>ament_python</build_type></export>'
    return 100.0, 'package.xml is complete'


def driver_package(workspace: Path) -> str:
    """Return the package that drives: husky_driver, as in the sheet, or one with follow_path."""
    packages = _packages(workspace)
    others = (name for name in packages if list(packages[name].glob('**/follow_path.py')))
    return 'husky_driver' if 'husky_driver' in packages else next(others, 'husky_driver')


def _packages(workspace: Path) -> dict[str, Path]:
    found = {}
    for manifest in sorted((workspace / 'src').glob('**/package.xml')):
        try:
            root = ElementTree.parse(manifest).getroot()
        except (ElementTree.ParseError, OSError):
            continue
        found[(root.findtext('name') or '').strip()] = manifest.parent
    return found


def build_step(workspace: Path, folder: Path) -> Verdict:
    """Build the workspace with colcon, into the report's folder, so that nothing of it changes."""
    command = ['colcon', '--log-base', str(folder / 'log'), 'build']
    command += ['--base-paths', str(workspace / 'src')]
    command += ['--build-base', str(folder / 'build'), '--install-base', str(folder / 'install')]
    try:
        exit_code = _run(command, folder / 'build.log')
    except FileNotFoundError:
        return 0.0, 'colcon is not installed here'
    if exit_code is None:
        return 0.0, f'colcon build took longer than {BUILD_WITHIN_SEC:g} s'
    if exit_code != 0:
        why = _first_error((folder / 'build.log').read_text(encoding='utf-8', errors='replace'))
        return 0.0, f'colcon build failed: {why}'
    return 100.0, 'colcon build succeeded'


def _run(command: list[str], log: Path) -> int | None:
    """Run it and end all that it started; return its exit code, None where it took too long."""
    with (
        log.open('w', encoding='utf-8') as stream,
        descendants_ended(),
        ChildProcess(command, os.environ, stream, parent_death=signal.SIGKILL) as process,
    ):
        return process.exit_code if process.wait(BUILD_WITHIN_SEC) else None


def _first_error(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if 'rror' in line]
    return lines[0] if lines else 'see build.log'


def sourced(folder: Path) -> dict[str, str]:
    """
    Return the environment after sourcing what was built.

    :raises ValueError: when nothing was built, or sourcing fails or takes too long.
    """
    if not (folder / 'install' / 'local_setup.bash').is_file():
        raise ValueError('nothing was built')
    script = 'source "$0/install/local_setup.bash" >/dev/null 2>&1; env -0'
    command = ['bash', '-c', script, str(folder)]
    with (
        TemporaryFile('w+', encoding='utf-8', errors='surrogateescape', newline='') as told,
        descendants_ended(),
        ChildProcess(command, os.environ, told, parent_death=signal.SIGKILL) as process,
    ):
        in_time = process.wait(SOURCE_WITHIN_SEC)
        told.seek(0)
        pairs = [entry.partition('=') for entry in told.read().split('\0') if entry]
    if not in_time:
        raise ValueError(
            f'sourcing install/local_setup.bash took longer than {SOURCE_WITHIN_SEC:g} s; '
            'a hook of a package waits for something: take it out'
        )
    if process.exit_code != 0 or not pairs:
        raise ValueError(
            f'sourcing install/local_setup.bash ended the shell (exit code {process.exit_code}); '
            'a hook of a package must not call exit'
        )
    return {name: value for name, _, value in pairs}


def find_executable(folder: Path, package: str, name: str) -> Path:
    """
    Return an executable that `ros2 run` would find.

    :raises ProgramMissing: when there is none.
    """
    programs = folder / 'install' / package / 'lib' / package
    for candidate in (programs / name, programs / f'{name}.py'):
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return candidate
    if not (folder / 'install' / package).is_dir():
        raise ProgramMissing(
            f'ros2 run {package} {name} finds nothing: there is no package {package}'
        )
    have = ', '.join(sorted(p.name for p in programs.glob('*'))) if programs.is_dir() else ''
    raise ProgramMissing(
        f'ros2 run {package} {name} finds nothing; {package} has: {have or "no executables"}; '
        f"add '{name} = {package}.{name}:main' to console_scripts in its setup.py"
    )
