# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Judge a run: its measurements, its score and the reasons for it.

Score: 100 x completion x 0.65 per collision x time x tracking x alone. Every part is between 0
and 1 and says why; what it costs is counted in points, in this order. The factor for a collision
is the CARLA leaderboard's for a static obstacle.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from husky_course.record import Run
from husky_course.route import Route

from husky_grader.scoring.alignment import align
from husky_grader.scoring.measurement import measure, Measurement
from husky_grader.scoring.reasons import disturbance_lines, reasons_for

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
  time        1 within {TIME_ALLOWANCE} x the time at the asked speed, that to the first waypoint
              as well, then in proportion, not below {MIN_TIME_FACTOR};
              times 1 - {1 - TOO_FAST_FACTOR} x the share of the time driven too fast
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


@dataclass(frozen=True, eq=False, kw_only=True)
class Report(Measurement):
    """What a run is worth."""

    course: str
    wall_time_sec: float | None
    score: float
    parts: tuple[Part, ...]
    reasons: tuple[str, ...]  # what went wrong; empty for a good run
    ending: str = ''  # of a controller's run: why it was over
    pace: str = ''  # and how its time passed
    printed: str = ''  # by the controller, the beginning and the end of it

    @property
    def passed(self) -> bool:
        """Whether the run passed; the only place that decides it."""
        trouble = self.collisions or self.disturbances or self.ended_early
        return self.completed and not trouble


def judge(
    run: Run, route: Route, *, wall_time_sec: float | None = None, interface: str = 'lab'
) -> Report:
    """
    Return the report on a run.

    :param interface: by which topics the Husky was driven: lab or clearpath.
    """
    measured = measure(run, route, align(run, route))
    reasons = reasons_for(run, route, measured, interface)
    factors = [
        ('completion', _completion(measured)),
        ('collisions', _collisions([touch.obstacle for touch in measured.collisions])),
        ('time', _time(measured, route.par_time_sec, _lead_in_sec(run, route))),
        ('tracking', _tracking(measured.cross_track_rms_m, measured.wrong_way)),
    ]
    if measured.disturbances:
        factors.append(('alone', (0.0, '; '.join(disturbance_lines(run)))))
    points, parts = _total(factors)
    return Report(
        **vars(measured),
        course=route.course.name,
        wall_time_sec=wall_time_sec,
        score=points,
        parts=parts,
        reasons=reasons,
    )


def digits_apart(number: float, other: float, *, least: int) -> int:
    """
    Return how many digits behind the point tell a number from another one.

    :param least: so many at least.

    >>> [digits_apart(number, 60.0, least=1) for number in (61.0, 60.02, 60.0)]
    [1, 2, 1]
    """
    digits = least
    while number != other and f'{number:.{digits}f}' == f'{other:.{digits}f}':
        digits += 1
    return digits


def _completion(measured: Measurement) -> tuple[float, str]:
    """Return the factor; the first waypoint is where the robot starts and earns nothing."""
    reached, total = measured.waypoints_reached, measured.waypoints_total
    why = f'{reached} of {total} waypoints reached in order'
    factor = max(reached - 1, 0) / (total - 1)
    if not measured.stands_at_end:
        factor *= NOT_STOPPED_FACTOR
        why += '; not standing at the last waypoint in the end'
    return factor, why


def _collisions(obstacles: Sequence[str]) -> tuple[float, str]:
    if not obstacles:
        return 1.0, 'nothing touched'
    names = ', '.join(dict.fromkeys(obstacles))
    times = 'once' if len(obstacles) == 1 else f'{len(obstacles)} times'
    return COLLISION_FACTOR ** len(obstacles), f'touched {times}: {names}'


def _lead_in_sec(run: Run, route: Route) -> float:
    """Return how long the way to the first waypoint takes, where the drive begins elsewhere."""
    begin = float(run.x[run.begin]), float(run.y[run.begin])
    return route.begun_at(begin).par_time_sec - route.par_time_sec


def _time(measured: Measurement, route_par_sec: float, lead_in_sec: float) -> tuple[float, str]:
    """Return the factor for the time; allowed is that for as much of the path as was driven."""
    needed_sec = measured.sim_time_sec
    par_sec = measured.progress_m / measured.path_length_m * route_par_sec
    if needed_sec <= 0.0:
        return 1.0, 'it did not drive'
    if par_sec <= 0.0:
        return 1.0, 'it did not drive along the path'
    allowed = TIME_ALLOWANCE * (lead_in_sec + par_sec)
    factor = min(1.0, max(allowed / needed_sec, MIN_TIME_FACTOR))
    digits = digits_apart(needed_sec, allowed, least=1) if factor < 1.0 else 1
    why = f'{needed_sec:.{digits}f} s, full marks up to {allowed:.{digits}f} s'
    if measured.too_fast > 0.005:
        factor *= 1.0 - (1.0 - TOO_FAST_FACTOR) * measured.too_fast
        why += f'; {measured.too_fast:.0%} of the time faster than asked'
    return factor, why


def _tracking(rms_m: float, wrong_way: float) -> tuple[float, str]:
    share = (NO_TRACKING_M - rms_m) / (NO_TRACKING_M - FULL_TRACKING_M)
    digits = digits_apart(rms_m, FULL_TRACKING_M, least=3) if share < 1.0 else 3
    why = f'{rms_m:.{digits}f} m RMS off the path, full marks up to {FULL_TRACKING_M:.2f} m'
    factor = min(max(share, 0.0), 1.0)
    if wrong_way > 0.0:
        factor *= 1.0 - (1.0 - WRONG_WAY_FACTOR) * wrong_way
        why += f'; {wrong_way:.0%} of the way in the wrong direction'
    return factor, why


def _total(factors: Sequence[tuple[str, tuple[float, str]]]) -> tuple[float, tuple[Part, ...]]:
    """Multiply the factors; return the score and what each part cost on the way."""
    points = 100.0
    parts = []
    for name, (factor, why) in factors:
        after = points * factor
        parts.append(Part(name, factor, points - after, why))
        points = after
    return points, tuple(parts)
