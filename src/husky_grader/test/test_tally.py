# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import errno
from io import StringIO
import os

from husky_grader.tally import Tally
import pytest


class Failing(StringIO):
    """A stream whose every write fails."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self._error = OSError(number, os.strerror(number))

    def flush(self) -> None:
        raise self._error


def test_a_tally_counts_to_the_last_file() -> None:
    stream = StringIO()
    tally = Tally(30, stream, '', bar=False)
    for number in range(30):
        tally.add(f's{number} 100.0')
    assert stream.getvalue().splitlines()[-1] == '30 of 30  s29 100.0'
    assert len(stream.getvalue().splitlines()) == 10


def test_a_tally_on_a_full_disk_ends_no_work() -> None:
    tally = Tally(3, Failing(errno.ENOSPC), 'begun', bar=True)
    tally.add('s0 100.0')
    tally.close()


def test_a_tally_ends_with_its_reader() -> None:
    tally = Tally(3, Failing(errno.EPIPE), '', bar=False)
    with pytest.raises(BrokenPipeError):
        tally.add('s0 100.0')
