# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a path was driven, beside where: faster than asked, or facing the wrong way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
import math

from husky_driver.route import Leg
from husky_driver.run_record import RunRecord

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


def pieces_of(legs: Sequence[Leg], along_m: Sequence[float]) -> list[Piece]:
    """Return the piece of the path for each place along it; the places never go back."""
    pieces, number, result = _pieces(legs), 0, []
    for along in along_m:
        while number < len(pieces) - 1 and along > pieces[number].end_m:
            number += 1
        result.append(pieces[number])
    return result


def manner_of(
    run: RunRecord, pieces: Sequence[Piece], along_m: Sequence[float], judged: Sequence[int]
) -> Manner:
    """Look at the entries of a run that are judged; `pieces` and `along_m` are of all entries."""
    cusps = {a.end_m for a, b in pairwise(pieces) if a.reverse != b.reverse}
    fast, wrong_m, driven_m = 0, {True: 0.0, False: 0.0}, 0.0
    for i in judged:
        asked, speed = pieces[i], run.speed_m_s[i]
        fast += abs(speed) > TOO_FAST * asked.speed_m_s + 0.02
        step_m = _step_m(run, i)
        driven_m += step_m
        if (speed < 0.0) != asked.reverse and all(abs(along_m[i] - s) > CUSP_M for s in cusps):
            wrong_m[speed < 0.0] += step_m
    share = sum(wrong_m.values()) / driven_m if sum(wrong_m.values()) > ENOUGH_M else 0.0
    count = max(len(judged), 1)
    return Manner(fast / count, share, wrong_m[True], wrong_m[False])


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


def _step_m(run: RunRecord, i: int) -> float:
    return math.hypot(run.x[i] - run.x[i - 1], run.y[i] - run.y[i - 1]) if i else 0.0
