# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How `ros2 doctor` prints."""

from __future__ import annotations

from collections.abc import Sequence
import sys
from typing import Any

_NARROWEST = 8
_GAP = 4


def format_print(report: Any) -> None:
    """Print a report: its items below each other, their values in one column."""
    print('\n  ', report.name)
    width = compute_padding(report.items) if report.items else 0
    for name, value in report.items:
        print(f'{name:<{width}}: {value}')


def compute_padding(report_items: Sequence[tuple[str, Any]]) -> int:
    """Return the width of the column of names."""
    longest = max(len(name) for name, _ in report_items)
    return _NARROWEST if longest < _NARROWEST else longest + _GAP


def doctor_warn(msg: str) -> None:
    print(f'note: {msg}', file=sys.stderr)


def doctor_error(msg: str) -> None:
    print(f'problem: {msg}', file=sys.stderr)
