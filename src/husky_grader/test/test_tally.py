# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

from husky_grader.tally import Tally
import pytest

from husky_grader import tally as tally_module


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


def test_a_tally_tells_how_long_the_rest_will_take(monkeypatch: pytest.MonkeyPatch) -> None:
    now_sec, stream = 100.0, StringIO()
    monkeypatch.setattr(tally_module, 'time', SimpleNamespace(monotonic=lambda: now_sec))
    tally = Tally(10, stream, '', bar=False)
    tally.add('kept', is_new=False)
    for took_sec in (3.0, 3.0, 60.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0):
        now_sec += took_sec
        tally.add('new')
    assert stream.getvalue().splitlines() == [
        '1 of 10  kept',
        '2 of 10  new',  # one alone tells nothing
        '3 of 10  about 21 s left  new',
        '4 of 10  about 2 min left  new',
        '5 of 10  about 85 s left  new',
        '6 of 10  about 56 s left  new',
        '7 of 10  about 36 s left  new',
        '8 of 10  about 21 s left  new',
        '9 of 10  about 10 s left  new',
        '10 of 10  new',
    ]
    short = StringIO()
    tally = Tally(3, short, '', bar=False)
    for _ in range(2):
        now_sec += 4.9
        tally.add('new')
    assert short.getvalue().splitlines()[-1] == '2 of 3  new', 'less than 5 s'


def test_a_bar_grows_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('COLUMNS', '60')
    stream = StringIO()
    tally = Tally(2, stream, 'begun', bar=True)
    for name in ('a' * 60, 'b'):
        tally.add(name)
    tally.close()
    begun, half, whole = stream.getvalue().removesuffix('\n').split('\r')[1:]
    assert begun.rstrip() == f'[{"." * 30}] 0 of 2  begun'
    assert half == f'[{"#" * 15}{"." * 15}] 1 of 2  {"a" * 18}'
    assert whole.rstrip() == f'[{"#" * 30}] 2 of 2  b'
    assert {len(text) for text in (begun, half, whole)} == {59}, 'nothing of the last one stays'


def test_a_tally_on_a_full_disk_ends_no_work() -> None:
    with Path('/dev/full').open('w') as full:  # also to close it would fail
        tally = Tally(3, full, 'begun', bar=True)
        tally.add('s0 100.0')
        tally.close()


def test_a_tally_ends_with_its_reader() -> None:
    tally = Tally(3, Unread(), '', bar=False)
    with pytest.raises(BrokenPipeError):
        tally.add('s0 100.0')
