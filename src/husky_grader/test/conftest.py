# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A folder for each test to which every user can pass: a sandbox may run programs as another."""

from collections.abc import Iterator
from contextlib import contextmanager
import os
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

# Only root can make the container that these tests run in.
collect_ignore = [] if os.geteuid() == 0 else ['test_jail_in_container.py']


@contextmanager
def _open_folder() -> Iterator[Path]:
    with TemporaryDirectory(prefix='test-') as name:
        Path(name).chmod(0o755)
        yield Path(name)


@pytest.fixture
def tmp_path() -> Iterator[Path]:
    with _open_folder() as folder:
        yield folder


@pytest.fixture(scope='module')
def module_path() -> Iterator[Path]:
    """Return such a folder that the tests of a file share."""
    with _open_folder() as folder:
        yield folder
