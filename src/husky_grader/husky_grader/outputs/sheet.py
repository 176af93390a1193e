# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A table that an LMS has given as CSV: read as it is, written again in the same form."""

from collections.abc import Sequence
import csv
from dataclasses import dataclass
import io
from pathlib import Path
import re

from husky_course.files import replacing
from husky_course.printable import printable

MAX_BYTES = 32_000_000
_DELIMITERS = (',', ';', '\t')
_NUMBER = re.compile(r'\d{1,9}(?:[.,]\d{1,9})?', re.ASCII)
_AGAIN = 'download it again, and give it as it is'


@dataclass(frozen=True)
class Sheet:
    """Its header and rows of equal length, and how they were written."""

    path: Path
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    delimiter: str = ','
    line_end: str = '\n'
    encoding: str = 'utf-8'  # or utf-8-sig, with a byte order mark


def read_sheet(path: Path) -> Sheet:
    """
    Read a table that an LMS has given.

    :raises ValueError: when it is no table, or its rows differ in length.
    :raises OSError: when it cannot be read.
    """
    if path.exists() and not path.is_file():
        raise ValueError(printable(f'{path}: not a file; give the CSV file of the LMS'))
    with path.open('rb') as stream:
        data = stream.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise ValueError(printable(f'{path}: larger than {MAX_BYTES / 1e6:g} MB; {_AGAIN}'))
    encoding = 'utf-8-sig' if data.startswith(b'\xef\xbb\xbf') else 'utf-8'
    try:
        text = data.decode(encoding)
        first = text.partition('\n')[0]
        delimiter = max(_DELIMITERS, key=first.count)
        lines = list(csv.reader(io.StringIO(text, newline=''), delimiter=delimiter, strict=True))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(printable(f'{path}: no CSV in UTF-8 ({error}); {_AGAIN}')) from None
    header, *rows = [line for line in lines if line] or [[]]
    for number, row in enumerate(rows, 2):
        if len(row) != len(header):
            raise ValueError(
                printable(
                    f'{path}: line {number} of the table has {len(row)} cells, its header has '
                    f'{len(header)}; {_AGAIN}'
                )
            )
    return Sheet(path, header, rows, delimiter, '\r\n' if '\r\n' in text else '\n', encoding)


def write_sheet(path: Path, sheet: Sheet) -> None:
    """Write a table in the form of its origin, whole or not at all."""
    with replacing(path) as part, part.open('w', newline='', encoding=sheet.encoding) as stream:
        writer = csv.writer(stream, delimiter=sheet.delimiter, lineterminator=sheet.line_end)
        writer.writerow(sheet.header)
        writer.writerows(sheet.rows)


def number_in(cell: str) -> float | None:
    """
    Return the number in a cell, with a point or a comma; None where it is none.

    >>> number_in('87,50')
    87.5
    """
    text = cell.strip()
    return float(text.replace(',', '.')) if _NUMBER.fullmatch(text) else None


def like(value: float, example: str) -> str:
    """
    Return a number with two digits behind a point, or a comma where an example has one.

    >>> like(87.5, '100,00')
    '87,50'
    """
    return f'{value:.2f}'.replace('.', ',' if ',' in example else '.')
