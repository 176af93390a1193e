# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Judge a run: the simulator's record and the waypoint file give a report."""

from __future__ import annotations

from dataclasses import dataclass
import math

from husky_course.record import Collision, Disturbance, read_run, Record, RunRecord
from husky_course.route import Route
from husky_course.waypoints import Course
import numpy as np
import numpy.typing as npt

from husky_grader.scoring import diagnosis, score_parts, verdict
from husky_grader.scoring.alignment import align
from husky_grader.scoring.driving_style import asked_of, manner_of
from husky_grader.scoring.score_parts import Part
from husky_grader.scoring.visits import waypoints_in_order

Array = npt.NDArray[np.float64]

STANDING_M_S = 0.02
STANDING_RAD_S = 0.05


@dataclass(frozen=True, eq=False)
class Report:
    """What a run is worth; `along_m`, `errors_m`, `asked_m_s` have one entry a period."""

    course: str
    completed: bool
    ended_early: bool  # the simulator was gone before the run was over
    waypoints_reached: int
    waypoints_total: int
    collisions: tuple[Collision, ...]
    disturbances: tuple[Disturbance, ...]
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
    along_m: Array
    errors_m: Array
    asked_m_s: Array
    visits: tuple[bool, ...]  # of `Course.stops`

    @property
    def passed(self) -> bool:
        trouble = self.collisions or self.disturbances or self.ended_early
        return self.completed and not trouble


def score(
    record: Record,
    route: Route,
    *,
    wall_time_sec: float | None = None,
    robot: str | None = None,
) -> Report:
    """
    Return the report on a run.

    :raises RecordRefused: when the record cannot be judged.
    """
    return judge(read_run(record, robot), route, wall_time_sec=wall_time_sec)


def judge(run: RunRecord, route: Route, *, wall_time_sec: float | None = None) -> Report:
    course, curve = route.course, route.curve
    end = _end(run)
    along, errors = align(curve, run.x, run.y)
    visits = waypoints_in_order(course, run.x[run.begin :], run.y[run.begin :])
    stands = _stands_at_end(run, course)
    judged = _judged(run, course, end)
    rms = math.sqrt(float(np.mean(errors[judged] ** 2))) if len(judged) else 0.0
    worst = float(np.abs(errors[judged]).max(initial=0.0))
    asked = asked_of(route.legs, along)
    manner = manner_of(run, asked, along, judged)
    reached, needed = sum(visits), float(run.time_sec[end])
    progress = float(along[judged].max(initial=0.0)) / curve.length_m
    factors = [
        ('completion', score_parts.completion(reached, len(visits), stands_at_end=stands)),
        ('collisions', score_parts.collisions([c.obstacle for c in run.collisions])),
        ('time', score_parts.time(needed, progress * route.par_time_sec, manner.too_fast)),
        ('tracking', score_parts.tracking(rms, manner.wrong_way)),
    ]
    if run.disturbances:
        factors.append(('alone', score_parts.alone(verdict.disturbances(run))))
    points, parts = score_parts.total(factors)
    guessed = []
    if reached < len(visits):
        guessed = diagnosis.guesses(run, course, curve, rms_m=rms, driven_m=_driven(run))
    accelerations = _accelerations(run, end)
    return Report(
        course=course.name,
        completed=reached == len(visits) and stands,
        ended_early=not run.complete,
        waypoints_reached=reached,
        waypoints_total=len(visits),
        collisions=run.collisions,
        disturbances=run.disturbances,
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
        begin=run.begin,
        end=end,
        along_m=along,
        errors_m=errors,
        asked_m_s=asked.speed_m_s,
        visits=tuple(visits),
    )


def _end(run: RunRecord) -> int:
    """Return the entry at the last motion, or at the last touch where something touched it."""
    moves = np.abs(run.speed_m_s) > STANDING_M_S
    moves |= np.abs(run.yaw_rate_rad_s) > STANDING_RAD_S
    last = np.flatnonzero(moves[run.begin + 1 :])
    end = run.begin + 1 + int(last[-1]) if len(last) else run.begin
    touched_sec = max((touch.time_sec for touch in run.collisions), default=0.0)
    touched = int(np.searchsorted(run.time_sec, touched_sec - 1e-9))
    return min(max(end, touched), len(run.x) - 1)


def _stands_at_end(run: RunRecord, course: Course) -> bool:
    last = course.stops[-1]
    away_m = math.hypot(run.x[-1] - last.x_m, run.y[-1] - last.y_m)
    stands = abs(run.speed_m_s[-1]) < STANDING_M_S and abs(run.yaw_rate_rad_s[-1]) < STANDING_RAD_S
    return bool(stands and away_m <= course.tolerance_m)


def _judged(run: RunRecord, course: Course, end: int) -> npt.NDArray[np.int64]:
    """Return the entries where the robot drove, from when it was at the first waypoint."""
    first, drive = course.waypoints[0], slice(run.begin, end + 1)
    away_m = np.hypot(run.x[drive] - first.x_m, run.y[drive] - first.y_m)
    start = int((away_m <= course.tolerance_m).argmax())  # 0 where it was never there
    moves = np.abs(run.speed_m_s[drive]) > STANDING_M_S
    moves[:start] = False
    return np.flatnonzero(moves) + run.begin


def _driven(run: RunRecord) -> float:
    return float(np.hypot(np.diff(run.x), np.diff(run.y)).sum())


def _accelerations(run: RunRecord, end: int) -> tuple[float, float]:
    """Return the RMS of acceleration and yaw acceleration: how smoothly it was driven."""
    drive = slice(run.begin, min(end, len(run.x) - 2) + 1)
    steps_sec = np.diff(run.time_sec[drive])
    if not len(steps_sec):
        return 0.0, 0.0
    linear, angular = (
        math.sqrt(float(np.mean((np.diff(values[drive]) / steps_sec) ** 2)))
        for values in (run.speed_m_s, run.yaw_rate_rad_s)
    )
    return linear, angular
