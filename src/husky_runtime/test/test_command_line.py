# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a person at a terminal is told."""

from pathlib import Path
import resource
import shutil

from husky_runtime.command_line import why
import pytest


def test_what_cannot_be_written_is_named_and_not_what_was_read(tmp_path: Path) -> None:
    (tmp_path / 'source').write_bytes(bytes(100_000))
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, before[1]))
    try:
        with pytest.raises(OSError) as caught:
            shutil.copyfile(tmp_path / 'source', tmp_path / 'copy')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert why(caught.value) == f'{tmp_path}/copy: File too large'
