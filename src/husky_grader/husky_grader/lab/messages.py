# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Judge messages by what a rubric asks of their fields."""

from collections.abc import Sequence
from ctypes import c_float
from dataclasses import replace
from itertools import pairwise
import math
import re
from statistics import median
from typing import Any

from husky_grader.lab.file_steps import asked
from husky_grader.rubric.steps import FieldCheck
from husky_grader.run.diagnosis import shortened

_FLOAT32 = re.compile(r'(sequence<)?float\b')  # as Python's messages name the type
_ROUND = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


def complaint(message: Any, checks: Sequence[FieldCheck]) -> str:
    """Return which field of a message holds something else than asked for; nothing if none."""
    for check in checks:
        value, kind = message, ''
        for name in check.field.split('.'):
            kind = value.get_fields_and_field_types()[name]
            value = getattr(value, name)
        held = _in_float32(check) if _FLOAT32.match(kind) else check
        entries = (
            [value] if isinstance(value, (str, bytes)) or not hasattr(value, '__len__') else value
        )
        for entry in entries:
            if not _fits(entry, held):
                return f'{check.field} is {_shown(entry, held)}; {asked(_wanted(check))}'
    return ''


def _in_float32(check: FieldCheck) -> FieldCheck:
    """Return a check with the numbers that such a field can hold: 0.1 is not among them."""
    return replace(
        check,
        equals=_float32(check.equals) if isinstance(check.equals, float) else check.equals,
        least=None if check.least is None else _float32(check.least),
        most=None if check.most is None else _float32(check.most),
    )


def _float32(value: float) -> float:
    return c_float(value).value


def _shown(value: Any, check: FieldCheck) -> str:
    if isinstance(value, float):
        rounded = float(f'{value:.3g}')  # no more than is the same in each grading
        return str(value if _fits(rounded, check) else rounded)
    return shortened(repr(value) if isinstance(value, str) else str(value))


def _fits(value: Any, check: FieldCheck) -> bool:
    text = str(value).strip()
    return (
        (check.form is None or check.form.fits(text))
        and (check.equals is None or value == check.equals)
        and (check.least is None or value >= check.least)
        and (check.most is None or value <= check.most)
    )


def _wanted(check: FieldCheck) -> str:
    words = []
    if check.form is not None:
        words.append(f'"{check.form}"')
    if check.equals is not None:
        words.append(repr(check.equals))
    if check.least is not None:
        words.append(f'{check.least:g} or more')
    if check.most is not None:
        words.append(f'{check.most:g} or less')
    return ' and '.join(words)


def rate_hz(times_sec: Sequence[float]) -> float:
    """Return how many messages came a second; 0 of a single one."""
    # Their median: that the machine stood still for a moment is not the publisher's fault.
    gaps = [after - before for before, after in pairwise(times_sec)]
    return 1.0 / max(median(gaps), 1e-3) if gaps else 0.0


def about(rate: float) -> str:
    """
    Return a rate as a person tells it: what a busy machine changes of it is not seen.

    >>> [about(rate) for rate in (4.93, 0.51, 198.0, 0.0)]
    ['5', '0.5', '200', '0']
    """
    if rate <= 0.0:
        return '0'
    power = 10.0 ** math.floor(math.log10(rate))
    nearest = min(_ROUND, key=lambda each: abs(math.log(each * power / rate)))
    return f'{nearest * power:g}'
