# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The score of an episode: an estimate while it lasts, and what the grader says in the end.

The estimate has the grader's formula with what is known by then: in the place of waypoints the
part of the path, without the points for standing at the end, for speed and for direction. A
touch is no part of it: it ends the episode.
"""

from collections.abc import Sequence
import math

from husky_course.record import Collision, read_run, Record
from husky_course.route import Route
from husky_grader.scoring import (
    FULL_TRACKING_M,
    judge,
    MIN_TIME_FACTOR,
    NO_TRACKING_M,
    NOT_STOPPED_FACTOR,
    Report,
    STANDING_M_S,
    TIME_ALLOWANCE,
)
import numpy as np

from husky_gym.progress import Progress
from husky_sim.config import SimulationConfig


class RunningScore:
    """Counts what an episode is worth so far; from 0 to 100."""

    def __init__(self, par_time_sec: float, length_m: float) -> None:
        self._par_time_sec = par_time_sec
        self._length_m = length_m
        self.restart()

    def restart(self) -> None:
        self._farthest_m = self._squares_m2 = 0.0
        self._moving = 0

    def add(self, place: Progress, *, speed_m_s: float) -> None:
        """Add a control period."""
        self._farthest_m = max(self._farthest_m, place.along_m)
        if abs(speed_m_s) > STANDING_M_S:
            self._moving += 1
            self._squares_m2 += place.offset_m * place.offset_m

    def value(self, time_sec: float) -> float:
        """Return the score at a time of the episode."""
        share = self._farthest_m / self._length_m
        allowed_sec = TIME_ALLOWANCE * share * self._par_time_sec
        time = min(1.0, max(allowed_sec / time_sec, MIN_TIME_FACTOR))
        rms_m = math.sqrt(self._squares_m2 / max(self._moving, 1))
        tracking = (NO_TRACKING_M - rms_m) / (NO_TRACKING_M - FULL_TRACKING_M)
        return 100.0 * NOT_STOPPED_FACTOR * share * time * min(max(tracking, 0.0), 1.0)


def report_on(
    rows: Sequence[Sequence[float]],
    collisions: Sequence[Collision],
    route: Route,
    config: SimulationConfig,
) -> Report:
    """
    Return what the grader says of an episode.

    :param rows: those of a record, from the start to the last period.
    """
    record = Record(
        file='',
        world=config.world,
        conditions=config.conditions,
        robots=config.robots,
        obstacles=(),  # the clearance, which is no part of the score, is left out
        rows=np.array(rows)[:, np.newaxis],
        collisions=tuple(collisions),
    )
    return judge(read_run(record), route)
