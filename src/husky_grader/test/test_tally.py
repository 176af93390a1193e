# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from io import StringIO
from pathlib import Path

from husky_grader.tally import Tally
import pytest


class Unread(StringIO):
    """A stream whose reader has ended."""

    def flush(self) -> None:
        raise BrokenPipeError


def test_a_tally_counts_to_the_last_file() -> None:
    stream = StringIO()
    tally = Tally(30, stream, '', bar=False)
    for number in range(30):
        tally.add(f's{number} 100.0')
    assert stream.getvalue().splitlines()[-1] == '30 of 30  s29 100.0'
    assert len(stream.getvalue().splitlines()) == 10


def test_a_tally_on_a_full_disk_ends_no_work() -> None:
    with Path('/dev/full').open('w') as full:  # also to close it would fail
        tally = Tally(3, full, 'begun', bar=True)
        tally.add('s0 100.0')
        tally.close()


def test_a_tally_ends_with_its_reader() -> None:
    tally = Tally(3, Unread(), '', bar=False)
    with pytest.raises(BrokenPipeError):
        tally.add('s0 100.0')
