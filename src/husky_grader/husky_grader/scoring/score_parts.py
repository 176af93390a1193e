# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The score and its parts: 100 x completion x 0.65 per collision x time x tracking x alone.

Every part is between 0 and 1 and says why; what it costs is counted in points, in this order.
The factor for a collision is the CARLA leaderboard's for a static obstacle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

COLLISION_FACTOR = 0.65
NOT_STOPPED_FACTOR = 0.8
TIME_ALLOWANCE = 1.15  # times the time at the asked speed
MIN_TIME_FACTOR = 0.5
TOO_FAST_FACTOR = 0.5  # for a path driven too fast from beginning to end
FULL_TRACKING_M = 0.10
NO_TRACKING_M = 0.50
WRONG_WAY_FACTOR = 0.5  # for a path driven backwards from beginning to end

FORMULA = f"""\
score = 100 x completion x {COLLISION_FACTOR} per collision x time x tracking x alone
  completion  waypoints reached in order, without the first, of all without the first;
              times {NOT_STOPPED_FACTOR} unless the robot stands at the last one in the end
  time        1 within {TIME_ALLOWANCE} x the time at the asked speed, then in proportion, not
              below {MIN_TIME_FACTOR}; times 1 - {1 - TOO_FAST_FACTOR} x the share driven too fast
  tracking    1 up to {FULL_TRACKING_M:.2f} m RMS off the path, 0 from {NO_TRACKING_M:.2f} m;
              times 1 - {1 - WRONG_WAY_FACTOR} x the share driven backwards where the course asks
              for forwards, or forwards where it asks for backwards (reverse: true)
  alone       0 where others published commands, odometry or clock of the run, else not shown"""


@dataclass(frozen=True)
class Part:
    """One factor of the score, the points it cost, and why."""

    name: str
    factor: float
    cost_points: float
    why: str


def completion(reached: int, total: int, *, stands_at_end: bool) -> tuple[float, str]:
    """Return the factor; the first waypoint is where the robot starts and earns nothing."""
    why = f'{reached} of {total} waypoints reached in order'
    factor = max(reached - 1, 0) / (total - 1)
    if not stands_at_end:
        factor *= NOT_STOPPED_FACTOR
        why += '; not standing at the last waypoint in the end'
    return factor, why


def collisions(obstacles: Sequence[str]) -> tuple[float, str]:
    if not obstacles:
        return 1.0, 'nothing touched'
    names = ', '.join(dict.fromkeys(obstacles))
    times = 'once' if len(obstacles) == 1 else f'{len(obstacles)} times'
    return COLLISION_FACTOR ** len(obstacles), f'touched {times}: {names}'


def time(needed_sec: float, par_sec: float, too_fast: float) -> tuple[float, str]:
    """
    Return the factor for the time.

    :param par_sec: the time at the asked speed for as much of the path as was driven.
    :param too_fast: the share of the path driven too fast.
    """
    if needed_sec <= 0.0 or par_sec <= 0.0:
        return 1.0, 'it did not drive'
    allowed = TIME_ALLOWANCE * par_sec
    factor = min(1.0, max(allowed / needed_sec, MIN_TIME_FACTOR))
    why = f'{needed_sec:.1f} s, full marks up to {allowed:.1f} s'
    if too_fast > 0.005:
        factor *= 1.0 - (1.0 - TOO_FAST_FACTOR) * too_fast
        why += f'; {too_fast:.0%} of the path faster than asked'
    return factor, why


def tracking(rms_m: float, wrong_way: float = 0.0) -> tuple[float, str]:
    """
    Return the factor for keeping to the path.

    :param wrong_way: the share of the way driven backwards instead of forwards, or the reverse.
    """
    share = (NO_TRACKING_M - rms_m) / (NO_TRACKING_M - FULL_TRACKING_M)
    why = f'{rms_m:.3f} m RMS off the path, full marks up to {FULL_TRACKING_M:.2f} m'
    factor = min(max(share, 0.0), 1.0)
    if wrong_way > 0.0:
        factor *= 1.0 - (1.0 - WRONG_WAY_FACTOR) * wrong_way
        why += f'; {wrong_way:.0%} of the way in the wrong direction'
    return factor, why


def alone(disturbances: Sequence[str]) -> tuple[float, str]:
    """Return the factor for a run that others took part in: it is worth nothing."""
    return 0.0 if disturbances else 1.0, '; '.join(disturbances)


def total(parts: Sequence[tuple[str, tuple[float, str]]]) -> tuple[float, tuple[Part, ...]]:
    """Multiply the factors; return the score and what each part cost on the way."""
    score = 100.0
    result = []
    for name, (factor, why) in parts:
        after = score * factor
        result.append(Part(name, factor, score - after, why))
        score = after
    return score, tuple(result)
