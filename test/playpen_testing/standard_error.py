# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read what this process writes to its standard error while it is still written to."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import os
import sys
from tempfile import TemporaryFile


@contextmanager
def standard_error() -> Iterator[Callable[[], str]]:
    """
    Give a function that returns all that nodes have logged since, as often as it is asked.

    To wait for a text: capfd.readouterr() loses what another thread writes while it reads, so that
    it is for what nobody writes any more.
    """
    with TemporaryFile('ab+') as file:  # appended: neither writing nor reading moves the other

        def text() -> str:
            size = os.fstat(file.fileno()).st_size
            return os.pread(file.fileno(), size, 0).decode()

        before = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield text
        finally:
            os.dup2(before, 2)
            os.close(before)
            sys.stderr.write(text())
