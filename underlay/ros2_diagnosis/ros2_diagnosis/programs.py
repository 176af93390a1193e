# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a program that is there cannot be run."""

from __future__ import annotations

import os
from pathlib import Path

NOTHING_RUNS_HERE = (
    'lies on a disk from which nothing may be run (it is mounted noexec, as USB sticks often are)'
)
MOVE = 'move the workspace to your home folder, and build it there'


def interpreter(program: Path) -> str:
    """Return what the first line of a script names, '' where it names nothing."""
    return _first_line(program).strip()


def why_unrunnable(program: Path) -> str | None:
    """Say why the kernel will not find the interpreter of a script, None where nothing is wrong.

    The kernel and `env` look for one whose name ends with the carriage return.
    """
    if not _first_line(program).endswith('\r\n'):
        return None
    return (
        f'its lines end as those of Windows (CRLF), so that it asks for {interpreter(program)!r} '
        "with a carriage return; run `sed -i 's/\\r$//'` on its source and build it again"
    )


def why_not_executable(program: Path) -> str | None:
    """Say why a file may not be executed, None where it may, or is not there."""
    if not program.is_file() or os.access(program, os.X_OK):
        return None
    if nothing_runs_on(program):
        return f'{program} {NOTHING_RUNS_HERE}: {MOVE}'
    return (
        f'{program} is not executable: `chmod +x {program}`, or, on a USB stick where that '
        f'changes nothing, {MOVE}'
    )


def nothing_runs_on(path: Path) -> bool:
    """Tell whether a file or folder lies on a disk from which nothing may be run."""
    return bool(os.statvfs(path).f_flag & os.ST_NOEXEC)


def _first_line(program: Path) -> str:
    try:
        with program.open('rb') as file:
            line = file.readline(256)
    except OSError:
        return ''
    return line[2:].decode(errors='replace') if line.startswith(b'#!') else ''
