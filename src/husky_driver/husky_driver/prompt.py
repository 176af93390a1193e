# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask at the terminal for a move, as the lab sheet does: speed, distance, forward."""

from collections.abc import Callable
from dataclasses import dataclass
import math
from typing import TypeVar

from husky_course.waypoints import MAX_SPEED_M_S, MIN_SPEED_M_S

MIN_DISTANCE_M = 0.05
MAX_DISTANCE_M = 100.0

T = TypeVar('T')


@dataclass(frozen=True)
class Move:
    """A straight move; the speed is positive, also backward."""

    speed_m_s: float
    distance_m: float
    forward: bool


def ask_move(ask: Callable[[str], str] = input, say: Callable[[str], None] = print) -> Move:
    """
    Return the answers; a wrong one is explained and asked again.

    :raises EOFError: at the end of the input.
    """

    def until_valid(question: str, read: Callable[[str], T]) -> T:
        while True:
            try:
                return read(ask(question).strip())
            except ValueError as error:
                say(str(error))

    say("Let's move your robot")
    speeds, distances = (MIN_SPEED_M_S, MAX_SPEED_M_S), (MIN_DISTANCE_M, MAX_DISTANCE_M)
    return Move(
        until_valid('Input your speed: ', lambda answer: _number(answer, 'm/s', *speeds)),
        until_valid('Type your distance: ', lambda answer: _number(answer, 'm', *distances)),
        until_valid('Forward?: ', _read_forward),
    )


def _number(answer: str, unit: str, low: float, high: float) -> float:
    allowed = f'allowed is {low:g} to {high:g} {unit}'
    try:
        number = float(answer)
    except ValueError:
        raise ValueError(f'{answer!r} is not a number; {allowed}') from None
    # As in the sheet, the sign does not count: the third question asks for the direction.
    if not math.isfinite(number) or not low <= abs(number) <= high:
        raise ValueError(f'{answer} is out of range; {allowed}')
    return abs(number)


def _read_forward(answer: str) -> bool:
    if answer.lower() in ('1', 'true', 'yes', 'y'):
        return True
    if answer.lower() in ('0', 'false', 'no', 'n'):
        return False
    raise ValueError(f'{answer!r} is not an answer; type 1 for forward or 0 for backward')
