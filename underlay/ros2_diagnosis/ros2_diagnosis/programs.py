# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a program that is there cannot be run."""

from __future__ import annotations

from pathlib import Path


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


def _first_line(program: Path) -> str:
    try:
        with program.open('rb') as file:
            line = file.readline(256)
    except OSError:
        return ''
    return line[2:].decode(errors='replace') if line.startswith(b'#!') else ''
