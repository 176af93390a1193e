# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which files of Fast DDS's shared memory are a run's own, whatever else runs on the machine."""

from collections.abc import Iterable
from pathlib import Path


def own_files(pids: Iterable[int]) -> set[Path]:
    """Return the files that these processes have mapped, and no other process has."""
    ours = set(pids)
    others = {int(process.name) for process in Path('/proc').glob('[0-9]*')} - ours
    return _mapped_by(ours) - _mapped_by(others)


def _mapped_by(pids: Iterable[int]) -> set[Path]:
    files: set[Path] = set()
    for pid in pids:
        try:
            rows = Path(f'/proc/{pid}/maps').read_text().splitlines()
        except OSError:  # it has ended meanwhile
            continue
        files.update(Path(row.split()[5]) for row in rows if 'fastrtps' in row)
    return files


def left(files: Iterable[Path]) -> list[str]:
    """Return which of the files are still there."""
    return sorted(file.name for file in files if file.exists())
