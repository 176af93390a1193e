# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How launch files are saved."""

from __future__ import annotations

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from os import PathLike
from pathlib import Path

from ..source_location import located_error


def refuse_utf_16(path: str | PathLike[str]) -> None:
    """Refuse a file as some editors of Windows save it.

    :raises ValueError: it is in UTF-16.
    """
    with Path(path).open('rb') as file:
        if file.read(2) in (BOM_UTF16_BE, BOM_UTF16_LE):
            error = ValueError('it is saved as UTF-16 (Windows: Unicode): save it as UTF-8')
            raise located_error(error, (str(path), 1))
