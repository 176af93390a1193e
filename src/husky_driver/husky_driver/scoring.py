# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Judge a run: the simulator's record and the waypoint file give a report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
import math
from typing import Any

from husky_driver import diagnosis, score_parts, verdict
from husky_driver.alignment import align
from husky_driver.manner import manner_of, pieces_of
from husky_driver.path import joined
from husky_driver.route import plan_route
from husky_driver.run_record import Collision, read_run, RunRecord
from husky_driver.score_parts import Part
from husky_driver.time_limit import par_time_sec
from husky_driver.visits import waypoints_in_order
from husky_driver.waypoints import Course

STANDING_M_S = 0.02
STANDING_RAD_S = 0.05


@dataclass(frozen=True)
class Report:
    """What a run is worth; `along_m`, `errors_m`, `asked_m_s` have one entry a period."""

    course: str
    completed: bool
    waypoints_reached: int
    waypoints_total: int
    collisions: tuple[Collision, ...]
    cross_track_rms_m: float
    cross_track_max_m: float
    min_clearance_m: float | None
    path_length_m: float
    driven_m: float
    sim_time_sec: float  # from the first command to the last motion
    wall_time_sec: float | None
    acceleration_rms_m_s2: float
    yaw_acceleration_rms_rad_s2: float
    trajectory_sha256: str
    score: float
    parts: tuple[Part, ...]
    reasons: tuple[str, ...]  # what went wrong, in words; empty for a good run
    begin: int  # first and last entry of the drive
    end: int
    along_m: tuple[float, ...]
    errors_m: tuple[float, ...]
    asked_m_s: tuple[float, ...]
    visits: tuple[bool, ...]  # of `Course.stops`

    @property
    def passed(self) -> bool:
        return self.completed and not self.collisions


def score(
    record: Mapping[str, Any],
    course: Course,
    *,
    wall_time_sec: float | None = None,
    robot: str | None = None,
) -> Report:
    """
    Return the report on a run.

    :raises RecordRefused: when the record cannot be judged.
    """
    return judge(read_run(record, robot), course, wall_time_sec=wall_time_sec)


def judge(run: RunRecord, course: Course, *, wall_time_sec: float | None = None) -> Report:
    legs = plan_route(course)
    curve = joined([leg.curve for leg in legs])
    begin, end = _span(run)
    along, errors = align(curve, run.x, run.y)
    visits = waypoints_in_order(course, run.x[begin:], run.y[begin:])
    at_end = math.dist((run.x[-1], run.y[-1]), _place(course)) <= course.tolerance_m
    stands = abs(run.speed_m_s[-1]) < STANDING_M_S and abs(run.yaw_rate_rad_s[-1]) < STANDING_RAD_S
    judged = _judged(run, course, begin, end)
    rms = math.sqrt(sum(errors[i] ** 2 for i in judged) / len(judged)) if judged else 0.0
    worst = max((abs(errors[i]) for i in judged), default=0.0)
    needed = run.time_sec[end] - run.time_sec[begin]
    progress = max((along[i] for i in judged), default=0.0) / curve.length_m
    pieces = pieces_of(legs, along)
    manner = manner_of(run, pieces, along, judged)
    reached = sum(visits)
    points, parts = score_parts.total(
        [
            (
                'completion',
                score_parts.completion(reached, len(visits), stands_at_end=stands and at_end),
            ),
            ('collisions', score_parts.collisions([c.obstacle for c in run.collisions])),
            ('time', score_parts.time(needed, progress * par_time_sec(legs), manner.too_fast)),
            ('tracking', score_parts.tracking(rms, manner.wrong_way)),
        ]
    )
    guessed = []
    if reached < len(visits):
        guessed = diagnosis.guesses(run, course, curve, rms_m=rms, driven_m=_driven(run))
    accelerations = _accelerations(run, begin, end)
    return Report(
        course=course.name,
        completed=reached == len(visits) and stands and at_end,
        waypoints_reached=reached,
        waypoints_total=len(visits),
        collisions=run.collisions,
        cross_track_rms_m=rms,
        cross_track_max_m=worst,
        min_clearance_m=run.min_clearance_m,
        path_length_m=curve.length_m,
        driven_m=_driven(run),
        sim_time_sec=needed,
        wall_time_sec=wall_time_sec,
        acceleration_rms_m_s2=accelerations[0],
        yaw_acceleration_rms_rad_s2=accelerations[1],
        trajectory_sha256=run.trajectory_sha256,
        score=points,
        parts=parts,
        reasons=(*verdict.reasons(run, course, visits, manner), *guessed),
        begin=begin,
        end=end,
        along_m=tuple(along),
        errors_m=tuple(errors),
        asked_m_s=tuple(piece.speed_m_s for piece in pieces),
        visits=tuple(visits),
    )


def _span(run: RunRecord) -> tuple[int, int]:
    """Return the entries at the first command and at the last motion."""
    count = len(run.x)
    begin = next(
        (i for i in range(count) if run.command_speed_m_s[i] or run.command_yaw_rate_rad_s[i]),
        1,
    )
    begin = max(begin - 1, 0)  # an entry holds the command of the period that it ends
    end = next((i for i in range(count - 1, begin, -1) if _moves(run, i)), begin)
    return begin, end


def _moves(run: RunRecord, i: int) -> bool:
    return abs(run.speed_m_s[i]) > STANDING_M_S or abs(run.yaw_rate_rad_s[i]) > STANDING_RAD_S


def _place(course: Course) -> tuple[float, float]:
    last = course.stops[-1]
    return last.x_m, last.y_m


def _judged(run: RunRecord, course: Course, begin: int, end: int) -> list[int]:
    """Return the entries where the robot drove, from when it was at the first waypoint."""
    first = course.waypoints[0]
    near = (
        i
        for i in range(begin, end + 1)
        if math.hypot(run.x[i] - first.x_m, run.y[i] - first.y_m) <= course.tolerance_m
    )
    start = next(near, begin)
    return [i for i in range(start, end + 1) if abs(run.speed_m_s[i]) > STANDING_M_S]


def _driven(run: RunRecord) -> float:
    return sum(
        math.hypot(run.x[i + 1] - run.x[i], run.y[i + 1] - run.y[i]) for i in range(len(run.x) - 1)
    )


def _accelerations(run: RunRecord, begin: int, end: int) -> tuple[float, float]:
    """Return the RMS of acceleration and yaw acceleration: how smoothly it was driven."""
    pairs = [
        (run.time_sec[i + 1] - run.time_sec[i], i) for i in range(begin, min(end, len(run.x) - 2))
    ]
    if not pairs:
        return 0.0, 0.0
    sums = [0.0, 0.0]
    for dt, i in pairs:
        sums[0] += ((run.speed_m_s[i + 1] - run.speed_m_s[i]) / dt) ** 2
        sums[1] += ((run.yaw_rate_rad_s[i + 1] - run.yaw_rate_rad_s[i]) / dt) ** 2
    return math.sqrt(sums[0] / len(pairs)), math.sqrt(sums[1] / len(pairs))
