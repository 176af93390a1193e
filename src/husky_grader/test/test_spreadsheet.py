# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import csv
from pathlib import Path

from husky_grader.spreadsheet import MAX_CELL, plain_cell, write_table
import pytest


@pytest.mark.parametrize(
    ('given', 'shown'),
    [
        ('=1+1', "'=1+1"),
        (' \t\n@SUM(A1)', "'@SUM(A1)"),
        ('＋1', "'＋1"),
        ('a;=1+1', "a;'=1+1"),  # two cells, where a semicolon ends one
        ('a; ""=1+1', 'a; ""\'=1+1'),
        ('"-1"', '"\'-1"'),
        ('a = b - c', 'a = b - c'),
        ('two\nlines \x1b[2J\u202e', r'two lines \x1b[2J\u202e'),
        (-1.5, -1.5),
        (None, ''),
    ],
)
def test_a_cell_is_one_line_and_no_formula(given: object, shown: object) -> None:
    assert plain_cell(given) == shown


def test_a_cell_is_no_longer_than_a_spreadsheet_takes() -> None:
    assert len(str(plain_cell('\x00' * 64_000))) == MAX_CELL


def test_a_table_that_fails_leaves_the_former_one(tmp_path: Path) -> None:
    path = tmp_path / 'table.csv'
    write_table(path, ['=a'], [['=b']])
    assert list(csv.reader(path.read_text().splitlines())) == [["'=a"], ["'=b"]]

    def rows() -> 'list[list[object]]':
        raise RuntimeError

    with pytest.raises(RuntimeError):
        write_table(path, ['c'], (row for _ in 'x' for row in rows()))
    assert path.read_text().startswith("'=a")
    assert list(tmp_path.iterdir()) == [path]
