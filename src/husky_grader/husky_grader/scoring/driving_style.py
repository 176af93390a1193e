# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a path was driven, beside where: faster than asked, or facing the wrong way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from husky_course.record import RunRecord
from husky_course.route import Leg
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

TOO_FAST = 1.10  # times the asked speed, plus 2 cm/s
ENOUGH_M = 0.3  # a shorter way in the wrong direction is a correction
CUSP_M = 0.2  # so near to where the direction changes, either is right


@dataclass(frozen=True)
class Manner:
    """Shares of the drive, and the metres driven in the direction that was not asked for."""

    too_fast: float
    wrong_way: float
    backwards_m: float
    forwards_m: float


@dataclass(frozen=True)
class Piece:
    """The path between two waypoints: where it ends, and how it is to be driven."""

    end_m: float
    speed_m_s: float
    reverse: bool


@dataclass(frozen=True, eq=False)
class Asked:
    """How the course wants each entry of a run driven."""

    speed_m_s: Array
    reverse: npt.NDArray[np.bool_]
    cusps_m: Array  # where along the path the direction changes


def asked_of(legs: Sequence[Leg], along_m: Array) -> Asked:
    """Return what is asked at each place along the path; the places are in order of time."""
    pieces = _pieces(legs)
    ends = np.array([piece.end_m for piece in pieces])
    reverse = np.array([piece.reverse for piece in pieces])
    number = np.minimum(np.searchsorted(ends, along_m), len(pieces) - 1)
    number = np.maximum.accumulate(number)  # who is past a waypoint is not before it again
    before, after = number[:-1], number[1:]
    return Asked(
        np.array([piece.speed_m_s for piece in pieces])[number],
        reverse[number],
        np.unique(ends[before[reverse[before] != reverse[after]]]),
    )


def manner_of(run: RunRecord, asked: Asked, along_m: Array, judged: Indices) -> Manner:
    """Look at the entries of a run that are judged; `asked` and `along_m` are of all entries."""
    speed = run.speed_m_s[judged]
    fast = np.abs(speed) > TOO_FAST * asked.speed_m_s[judged] + 0.02
    steps_m = np.hypot(np.diff(run.x, prepend=run.x[0]), np.diff(run.y, prepend=run.y[0]))[judged]
    wrong = (speed < 0.0) != asked.reverse[judged]
    for cusp_m in asked.cusps_m:
        wrong &= np.abs(along_m[judged] - cusp_m) > CUSP_M
    backwards_m = float(steps_m[wrong & (speed < 0.0)].sum())
    forwards_m = float(steps_m[wrong & (speed >= 0.0)].sum())
    wrong_m = backwards_m + forwards_m
    share = wrong_m / float(steps_m.sum()) if wrong_m > ENOUGH_M else 0.0
    too_fast = float(fast.mean()) if len(judged) else 0.0
    return Manner(too_fast, share, backwards_m, forwards_m)


def _pieces(legs: Sequence[Leg]) -> list[Piece]:
    begin, pieces = 0.0, []
    for leg in legs:
        ends = leg.curve.knot_s[1:]
        pieces += [
            Piece(begin + end, speed, leg.reverse)
            for end, speed in zip(ends, leg.speeds_m_s, strict=True)
        ]
        begin += leg.curve.length_m
    return pieces
