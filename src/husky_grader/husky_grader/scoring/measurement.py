# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measure a run against its route: deviation, waypoints, speed, direction and smoothness."""

from dataclasses import dataclass
import math

from husky_course.frames import Array, Indices
from husky_course.record import Collision, Disturbance, Run
from husky_course.route import Route
from husky_course.waypoints import Course
import numpy as np
import numpy.typing as npt

from husky_grader.scoring.alignment import Alignment

STANDING_M_S = 0.02
STANDING_RAD_S = 0.05
TOO_FAST = 1.10  # times the asked speed, plus 2 cm/s
ENOUGH_M = 0.3  # a shorter way in the wrong direction is a correction
CUSP_M = 0.2  # so near to where the direction changes, either is right


@dataclass(frozen=True, eq=False, kw_only=True)
class Measurement:
    """What a run did; `along_m`, `errors_m` and `asked_m_s` have one entry a control period."""

    completed: bool  # every waypoint reached, and standing at the last one
    ended_early: bool  # the simulator was gone before the run was over
    stands_at_end: bool
    waypoints_reached: int
    waypoints_total: int
    visits: tuple[bool, ...]  # of `Course.stops`
    collisions: tuple[Collision, ...]
    disturbances: tuple[Disturbance, ...]
    cross_track_rms_m: float
    cross_track_max_m: float
    min_clearance_m: float | None
    path_length_m: float
    progress_m: float  # the farthest place along the path
    driven_m: float
    sim_time_sec: float  # from the first command to the last motion
    acceleration_rms_m_s2: float
    yaw_acceleration_rms_rad_s2: float
    too_fast: float  # share of the drive
    wrong_way: float  # share of the way driven in the direction that was not asked for
    backwards_m: float  # driven backwards where forwards was asked for
    forwards_m: float  # driven forwards where backwards was asked for
    conditions: tuple[str, ...]  # of the run: settings that are not the default
    trajectory_sha256: str
    begin: int  # first and last entry of the drive
    end: int
    along_m: Array
    errors_m: Array
    asked_m_s: Array


@dataclass(frozen=True, eq=False)
class _AskedMotion:
    """Speed and direction that the course asks for at each entry of a run."""

    speed_m_s: Array
    reverse: npt.NDArray[np.bool_]
    cusps_m: Array  # where along the path the direction changes


def measure(run: Run, route: Route, aligned: Alignment) -> Measurement:
    """Return the measurements of a run."""
    course, along, errors = route.course, aligned.along_m, aligned.errors_m
    end = _end(run)
    moved = end > run.begin  # else it has reached nothing, however near the waypoints are
    visits = tuple(got and (moved or not number) for number, got in enumerate(aligned.visits))
    judged = _judged(run, aligned.begin, end)
    stands = _stands_at_end(run, course)
    asked = _asked_motion(route, along)
    backwards_m, forwards_m, wrong_way = _wrong_way(run, asked, along, judged)
    linear, angular = _accelerations(run, end)
    return Measurement(
        completed=all(visits) and stands,
        ended_early=not run.complete,
        stands_at_end=stands,
        waypoints_reached=sum(visits),
        waypoints_total=len(visits),
        visits=visits,
        collisions=run.collisions,
        disturbances=run.disturbances,
        cross_track_rms_m=math.sqrt(float(np.mean(errors[judged] ** 2))) if len(judged) else 0.0,
        cross_track_max_m=float(np.abs(errors[judged]).max(initial=0.0)),
        min_clearance_m=run.min_clearance_m,
        path_length_m=route.curve.length_m,
        progress_m=float(along[judged].max(initial=0.0)),
        driven_m=float(np.hypot(np.diff(run.x), np.diff(run.y)).sum()),
        sim_time_sec=float(run.time_sec[end]),
        acceleration_rms_m_s2=linear,
        yaw_acceleration_rms_rad_s2=angular,
        too_fast=_too_fast(run, asked, judged),
        wrong_way=wrong_way,
        backwards_m=backwards_m,
        forwards_m=forwards_m,
        conditions=run.conditions,
        trajectory_sha256=run.trajectory_sha256,
        begin=run.begin,
        end=end,
        along_m=along,
        errors_m=errors,
        asked_m_s=asked.speed_m_s,
    )


def _end(run: Run) -> int:
    """Return the entry at the last motion, or at the last touch where something touched it."""
    moves = np.abs(run.speed_m_s) > STANDING_M_S
    moves |= np.abs(run.yaw_rate_rad_s) > STANDING_RAD_S
    last = np.flatnonzero(moves[run.begin + 1 :])
    end = run.begin + 1 + int(last[-1]) if len(last) else run.begin
    touched_sec = max((touch.time_sec for touch in run.collisions), default=0.0)
    touched = int(np.searchsorted(run.time_sec, touched_sec - 1e-9))
    return min(max(end, touched), len(run.x) - 1)


def _stands_at_end(run: Run, course: Course) -> bool:
    last = course.stops[-1]
    away_m = math.hypot(run.x[-1] - last.x_m, run.y[-1] - last.y_m)
    stands = abs(run.speed_m_s[-1]) < STANDING_M_S and abs(run.yaw_rate_rad_s[-1]) < STANDING_RAD_S
    return bool(stands and away_m <= course.tolerance_m)


def _judged(run: Run, path_begin: int, end: int) -> Indices:
    """Return the entries where the robot drove, from when it was at the first waypoint."""
    begin = max(run.begin, path_begin)
    return np.flatnonzero(np.abs(run.speed_m_s[begin : end + 1]) > STANDING_M_S) + begin


def _asked_motion(route: Route, along_m: Array) -> _AskedMotion:
    """Return what is asked at each place along the path; the places are in order of time."""
    begin, ends_m, speeds, reverses = 0.0, list[float](), list[float](), list[bool]()
    for leg in route.legs:
        ends_m += [begin + end for end in leg.curve.knot_s[1:]]
        speeds += leg.speeds_m_s
        reverses += [leg.reverse] * len(leg.speeds_m_s)
        begin += leg.curve.length_m
    ends, reverse = np.array(ends_m), np.array(reverses)
    piece = np.minimum(np.searchsorted(ends, along_m), len(ends) - 1)
    piece = np.maximum.accumulate(piece)  # a waypoint that was passed stays passed
    before, after = piece[:-1], piece[1:]
    cusps_m = set(ends[before[reverse[before] != reverse[after]]].tolist())
    # np.unique would load numpy.ma, a twentieth of the time that grading a short course takes.
    return _AskedMotion(np.array(speeds)[piece], reverse[piece], np.array(sorted(cusps_m)))


def _too_fast(run: Run, asked: _AskedMotion, judged: Indices) -> float:
    fast = np.abs(run.speed_m_s[judged]) > TOO_FAST * asked.speed_m_s[judged] + 0.02
    return float(fast.mean()) if len(judged) else 0.0


def _wrong_way(
    run: Run, asked: _AskedMotion, along_m: Array, judged: Indices
) -> tuple[float, float, float]:
    """Return metres driven backwards and forwards against what was asked, and their share."""
    speed = run.speed_m_s[judged]
    steps_m = np.hypot(np.diff(run.x, prepend=run.x[0]), np.diff(run.y, prepend=run.y[0]))[judged]
    wrong = (speed < 0.0) != asked.reverse[judged]
    for cusp_m in asked.cusps_m:
        wrong &= np.abs(along_m[judged] - cusp_m) > CUSP_M
    backwards_m = float(steps_m[wrong & (speed < 0.0)].sum())
    forwards_m = float(steps_m[wrong & (speed >= 0.0)].sum())
    wrong_m = backwards_m + forwards_m
    share = wrong_m / float(steps_m.sum()) if wrong_m > ENOUGH_M else 0.0
    return backwards_m, forwards_m, share


def _accelerations(run: Run, end: int) -> tuple[float, float]:
    """Return the RMS of acceleration and yaw acceleration."""
    drive = slice(run.begin, min(end, len(run.x) - 2) + 1)
    steps_sec = np.diff(run.time_sec[drive])
    if not len(steps_sec):
        return 0.0, 0.0
    linear, angular = (
        math.sqrt(float(np.mean((np.diff(values[drive]) / steps_sec) ** 2)))
        for values in (run.speed_m_s, run.yaw_rate_rad_s)
    )
    return linear, angular
