# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a check has found."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """One fault, told in one line."""

    where: str
    what: str
    mend: str
    serious: bool = True  # False: worth knowing, but nothing need be wrong

    def __str__(self) -> str:
        return f'{self.where}: {self.what}; {self.mend}'
