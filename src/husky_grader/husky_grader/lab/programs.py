# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of a workspace that was built."""

from codecs import BOM_UTF8
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
import json
import os
from pathlib import Path
import sys
from tempfile import mkdtemp

from husky_grader.jail import Jail, remove, Sandbox
from husky_grader.jail.folders import home_of
from husky_grader.lab.file_steps import find_packages, Manifest, text_of
from husky_grader.rubric.steps import ProgramStep

MAX_DEPTH = 32  # folders in each other below share/PACKAGE, in which a launch file is looked for
MAX_FIRST_LINE = 256  # bytes; Linux reads no more of one
# By these a script asks for the Python that has ROS on Ubuntu.
_OF_UBUNTU = (b'#!/usr/bin/python3', b'#!/bin/python3', b'#!/usr/bin/python3.12')
_ELF = b'\x7fELF'  # elf(5): a program that was compiled
_BUILD_FAILED = 'its build has failed'
_RUNNING = 'running-'  # begins the names of the folders in which programs run


def is_there(path: Path) -> bool:
    """Tell whether a file or folder is there and may be read; links may lead in a circle."""
    return os.access(path, os.R_OK) and (path.is_file() or path.is_dir())


def remove_running(folder: Path) -> None:
    """Remove what programs have left in a report whose grading was killed."""
    for left in folder.glob(f'{_RUNNING}????????'):
        if is_there(home_of(left)):
            remove(left)


class ProgramMissing(ValueError):
    """There is no such executable; the message says what there is."""


@dataclass(frozen=True)
class Programs:
    """
    What the steps run.

    :param built: where the workspace was built.
    :param environment: that of a terminal in which it was sourced.
    :param interfaces: packages of the types that the grader needs.
    :param world: in which a Husky drives, an MJCF file; empty: the playpen.
    :param asked: packages that must be the student's own.
    """

    workspace: Path
    built: Path
    environment: Mapping[str, str]
    sandbox: Sandbox
    interfaces: Sequence[Path] = ()
    world: str = ''
    asked: Sequence[str] = ()

    @property
    def place(self) -> str:
        """Return how paths in the report begin: nobody's business, and nowhere the same."""
        return f'{self.built.parent}/'

    @contextmanager
    def jail(self) -> Iterator[Jail]:
        """
        Open a jail for one program: a network, a home and a folder that no other has been in.

        What was built can only be read there, so that a program finds it as the build has left it,
        and nothing of what another one has seen, such as a hidden course.
        """
        folder = Path(mkdtemp(prefix=_RUNNING, dir=self.built.parent))
        try:
            readable = [self.workspace, self.built]
            with Jail(self.sandbox, folder, readable=readable, without=self.asked) as jail:
                yield jail
        finally:
            remove(folder)

    def command_of(self, step: ProgramStep) -> list[str]:
        """
        Return what `ros2 run` would run, or `ros2 launch`, with the arguments of the step.

        :raises PackageMissing: when the package is not there.
        :raises ProgramMissing: when the program is not there.
        """
        program = self._program_of(step)
        before = ('ros2', 'launch') if step.launch else _python_for(program)
        return [*before, str(program), *given_words(step)]

    def _program_of(self, step: ProgramStep) -> Path:
        """Return the program; where several packages may be meant, that of the first with it."""
        missing: list[ProgramMissing] = []
        for package in find_packages(self.workspace, step.package, step.package_with):
            try:
                if step.launch:
                    return find_launch_file(self.built, package, step.launch)
                return find_executable(self.built, package, step.executable)
            except ProgramMissing as error:
                missing.append(error)
        raise missing[0]


def given_words(step: ProgramStep) -> list[str]:
    """Return what a program of a step is started with: its arguments and parameters."""
    words = [*step.arguments]
    if step.parameters:
        words.append('--ros-args')
        for name, value in step.parameters.items():
            words += ['-p', f'{name}:={json.dumps(value)}']  # JSON is YAML, as rcl reads it
    return words


def wrong_first_line(program: Path) -> str:
    """Return why the first line of a program keeps it from being started; nothing if it does."""
    with suppress(OSError), program.open('rb') as stream:
        line = stream.readline(MAX_FIRST_LINE)
        if line.startswith(BOM_UTF8):
            return 'it begins with a byte order mark; save it as UTF-8 without one'
        if not line.startswith((b'#!', _ELF)):
            return 'its first line has to say by what it runs: #!/usr/bin/env python3'
        if line.startswith(b'#!') and line.endswith(b'\r\n'):
            return 'its lines end as on Windows (CRLF); save it with those of Linux (LF)'
    return ''


def _python_for(program: Path) -> list[str]:
    """Return this Python for a script that asks for Ubuntu's, which knows no wheels of ROS."""
    if sys.prefix != sys.base_prefix:
        with suppress(OSError), program.open('rb') as stream:
            if stream.readline(MAX_FIRST_LINE).rstrip(b' \n') in _OF_UBUNTU:
                return [sys.executable]
    return []


def find_launch_file(folder: Path, manifest: Manifest, name: str) -> Path:
    """
    Return a launch file that `ros2 launch` would find.

    :param folder: where the workspace was built.
    :param manifest: of its package.
    :raises ProgramMissing: when there is none.
    """
    share = folder / 'install' / manifest.name / 'share' / manifest.name
    command = f'ros2 launch {manifest.name} {name}'
    _check_installed(folder, manifest, share, command)
    files = sorted(path for path in _below(share) if is_there(path) and path.is_file())
    found = [path for path in files if path.name == name]
    if len(found) > 1:
        places = ' and '.join(path.relative_to(share).as_posix() for path in found)
        raise ProgramMissing(f'{command} finds two: {places}; install one')
    if found:
        return found[0]
    have = ', '.join(path.name for path in files if '.launch' in path.name) or 'no launch files'
    put = f'put it into share/{manifest.name}/launch, by data_files in its setup.py or install in '
    put += 'CMakeLists.txt'
    what_to_do = _BUILD_FAILED if _has_failed(folder, manifest.name) else put
    raise ProgramMissing(
        f'{command} finds nothing; {manifest.name} has installed: {have}; {what_to_do}'
    )


def _below(folder: Path) -> Iterator[Path]:
    """Yield the files in a folder and in those below it, which a build may nest without end."""
    for place, folders, files in os.walk(folder):
        yield from (Path(place, name) for name in files)
        if len(Path(place).relative_to(folder).parts) >= MAX_DEPTH:
            folders.clear()  # Path.rglob and os.walk end with Python's stack


def _check_installed(folder: Path, manifest: Manifest, place: Path, command: str) -> None:
    """Check that a package was built, and that a folder of it lies in what was built."""
    if not is_there(folder / 'install' / manifest.name):
        raise ProgramMissing(f'{command} finds nothing: package {manifest.name} was not built')
    # What is listed is told: nobody may point it at a folder of the grader's.
    if not _is_below(place, folder):
        raise ProgramMissing(
            f'{command}: {place.relative_to(folder)} leads out of the workspace; let the build '
            'put the files there'
        )


def _is_below(place: Path, folder: Path) -> bool:
    """Tell whether a place lies in a folder when all links are followed."""
    # By os.path: Path.resolve fails where links lead in a circle.
    return Path(os.path.realpath(place)).is_relative_to(os.path.realpath(folder))


def find_executable(folder: Path, manifest: Manifest, name: str) -> Path:
    """
    Return an executable that `ros2 run` would find.

    :param folder: where the workspace was built.
    :param manifest: of its package.
    :raises ProgramMissing: when there is none.
    """
    package = manifest.name
    programs = folder / 'install' / package / 'lib' / package
    _check_installed(folder, manifest, programs, f'ros2 run {package} {name}')
    for candidate in (programs / name, programs / f'{name}.py'):
        if os.access(candidate, os.X_OK) and candidate.is_file():
            return candidate
    have = ', '.join(sorted(p.name for p in programs.glob('*'))) if is_there(programs) else ''
    raise ProgramMissing(
        f'ros2 run {package} {name} finds nothing; {package} has: {have or "no executables"}; '
        f'{_what_to_do(folder, programs, manifest, name)}'
    )


def _has_failed(folder: Path, package: str) -> bool:
    """
    Tell whether the build of a package has failed, by what colcon has left of it.

    Another package's build may have put a link there, to what root waits for, as /proc/kmsg.
    """
    left = folder / 'build' / package / 'colcon_build.rc'
    if not (is_there(left) and left.is_file() and _is_below(left, folder)):
        return False
    with left.open('rb') as stream:
        return stream.read(4).strip() != b'0'


def _what_to_do(folder: Path, programs: Path, manifest: Manifest, name: str) -> str:
    """Return in words what puts a program where `ros2 run` looks for it."""
    package = manifest.name
    for there in (programs / name, programs / f'{name}.py'):
        if is_there(there):
            return f'{there.name} may not be executed: install it by PROGRAMS, or chmod +x it'
    if is_there(programs.parents[1] / 'bin' / name):
        return (
            f'it was put into install/{package}/bin; its setup.cfg lacks: [install] '
            f'install_scripts=$base/lib/{package}'
        )
    if (manifest.folder / 'setup.py').is_file() and _has_failed(folder, package):
        return _BUILD_FAILED
    if (manifest.folder / 'setup.py').is_file():
        return f"add '{name} = {package}.{name}:main' to console_scripts in its setup.py"
    if 'ament_python' in map(text_of, manifest.root.findall('export/build_type')):
        return 'it has no setup.py; ros2 pkg create --build-type ament_python makes one'
    return f'install {name} into lib/{package} in its CMakeLists.txt'
