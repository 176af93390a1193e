# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a jail's folder holds is counted while programs make and remove files in it."""

from collections.abc import Iterator
from contextlib import contextmanager
import math
import os
from pathlib import Path
from types import SimpleNamespace

from husky_grader.jail import Limits
from husky_grader.jail.usage import Usage
import pytest

LIST = os.scandir


@contextmanager
def removing_first(folder: str) -> Iterator[list['os.DirEntry[str]']]:
    """List a folder by names; what is first has been removed when it is looked at."""
    with LIST(folder) as listed:
        entries = sorted(listed, key=lambda entry: entry.name)
    if entries and entries[0].is_file():
        Path(entries[0].path).unlink()
    yield entries


def test_files_count_beside_one_that_was_just_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / 'inner').mkdir()
    for name in ('a', 'b', 'inner/a', 'inner/b'):
        (tmp_path / name).write_bytes(bytes(600_000))
    usage = Usage(tmp_path, Limits(folder_mb=1))
    monkeypatch.setattr(os, 'scandir', removing_first)
    due = SimpleNamespace(monotonic=lambda: math.inf)
    monkeypatch.setattr('husky_grader.jail.usage.time', due)
    assert usage.too_much(list) == 'filled its folder with over 1 MB'
