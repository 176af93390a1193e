# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tables for a spreadsheet, in which nothing that others wrote is taken for a formula."""

from collections.abc import Iterable, Sequence
import csv
from pathlib import Path
import re

from husky_course.files import replacing
from husky_course.printable import printable

from husky_grader.run.diagnosis import shortened

MAX_CELL = 32_000  # characters; Excel takes 32 767

# What begins like this is a formula (OWASP, CSV Injection). So is what follows a semicolon, where
# the spreadsheet takes that for the end of a cell; quotes before it would be taken off.
_FORMULA = re.compile(r'(?:^|;)[\s"]*(?=[=+@＝＋－＠-])')


def write_table(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write a table as CSV, whole or not at all."""
    with replacing(path) as part, part.open('w', newline='', encoding='utf-8') as stream:
        writer = csv.writer(stream)
        writer.writerow(map(plain_cell, header))
        writer.writerows(map(plain_cell, row) for row in rows)


def plain_cell(value: object) -> object:
    """
    Return what a cell shows of a value: of a text one line, which no spreadsheet computes.

    >>> plain_cell('=1+1')
    "'=1+1"
    """
    if isinstance(value, str):
        text = printable(' '.join(value.split()))
        return shortened(_FORMULA.sub(r"\g<0>'", text), MAX_CELL)
    return '' if value is None else value
