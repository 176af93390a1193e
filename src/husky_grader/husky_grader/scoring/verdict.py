# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Say in words what went wrong in a run, most important first."""

from __future__ import annotations

from collections.abc import Sequence
import math

from husky_course.record import Disturbance, RunRecord
from husky_course.waypoints import Course
import numpy as np

from husky_grader.scoring.driving_style import ENOUGH_M, Manner

MAX_LINES = 4  # of one kind
STANDING_M_S = 0.02
MOVED_M = 0.05


def reasons(
    run: RunRecord, course: Course, reached: Sequence[bool], manner: Manner
) -> tuple[str, ...]:
    """Return one line for each thing that went wrong; none for a good run."""
    first = [*disturbances(run), *_early_end(run)]
    if not _moved(run):
        return (*first, _why_still(run))
    wrong_way = _wrong_way(manner)
    lines = [*_collisions(run), *_missed(run, course, reached)]
    lines += _ending(run, course, all(reached))
    found = [*wrong_way, *lines] if manner.wrong_way > 0.5 else [*lines, *wrong_way]
    return (*first, *found)


def disturbances(run: RunRecord) -> list[str]:
    """Return one line for each time that others were heard."""
    return _shortened([_disturbance(entry) for entry in run.disturbances], 'disturbances')


def _disturbance(entry: Disturbance) -> str:
    names, topic = ' and '.join(entry.nodes), entry.topic
    when = f'disturbed at {entry.time_sec:.2f} s'
    if topic.endswith('/cmd_vel'):  # of these nodes, one is the driver
        both = 'both' if len(entry.nodes) == 2 else 'all'
        return f'{when}: {names} {both} published {topic}: nobody can tell whose drive it was'
    return (
        f'{when}: {names} published {topic} beside the simulator: nobody can tell what the '
        'driver heard'
    )


def _early_end(run: RunRecord) -> list[str]:
    if run.complete:
        return []
    return [
        f'the run ended early: its record breaks off at {run.time_sec[-1]:.2f} s, as when the '
        'simulator is killed or the disk is full'
    ]


def _moved(run: RunRecord) -> bool:
    return bool(np.hypot(run.x - run.x[0], run.y - run.y[0]).max() > MOVED_M)


def _why_still(run: RunRecord) -> str:
    if not run.command_speed_m_s.any() and not run.command_yaw_rate_rad_s.any():
        return (
            'it never moved: no command but zero arrived on husky_velocity_controller/cmd_vel; '
            'check the topic name and the message type'
        )
    if not run.command_speed_m_s.any():
        return 'it never moved from its place: it was only told to turn (linear.x was always 0)'
    return 'it never moved, although it was told to; was it told again every 0.25 s?'


def _collisions(run: RunRecord) -> list[str]:
    lines = [
        f'touched {touch.obstacle} with its {touch.part.replace("_", " ")} at '
        f'{touch.time_sec:.2f} s, with {touch.force_n:.0f} N'
        for touch in run.collisions
    ]
    return _shortened(lines, 'collisions')


def _missed(run: RunRecord, course: Course, reached: Sequence[bool]) -> list[str]:
    lines = []
    for number, (point, got) in enumerate(zip(course.stops, reached, strict=True)):
        if got:
            continue
        nearest = float(np.hypot(run.x - point.x_m, run.y - point.y_m).min())
        name = f'waypoint {number + 1} at ({point.x_m:g}, {point.y_m:g})'
        if nearest > course.tolerance_m:
            lines.append(
                f'missed {name}: it came no nearer than {nearest:.2f} m, '
                f'allowed are {course.tolerance_m:g} m'
            )
        else:
            lines.append(f'missed {name}: it was there, but not in its turn')
    return _shortened(lines, 'waypoints')


def _shortened(lines: list[str], what: str) -> list[str]:
    if len(lines) <= MAX_LINES:
        return lines
    return [*lines[: MAX_LINES - 1], f'... and {len(lines) - MAX_LINES + 1} more {what}']


def _ending(run: RunRecord, course: Course, all_reached: bool) -> list[str]:
    last = course.stops[-1]
    away = math.hypot(run.x[-1] - last.x_m, run.y[-1] - last.y_m)
    if abs(run.speed_m_s[-1]) > STANDING_M_S:
        return [f'did not stop: still driving {run.speed_m_s[-1]:.2f} m/s when the run ended']
    if away > course.tolerance_m:
        place = f'({run.x[-1]:.2f}, {run.y[-1]:.2f})'
        how = 'drove on and stopped' if all_reached else 'stopped'
        return [f'{how} at {place}, {away:.2f} m from the last waypoint']
    return []


def _wrong_way(manner: Manner) -> list[str]:
    if manner.wrong_way == 0.0:
        return []
    lines = [
        f'drove {manner.backwards_m:.2f} m backwards where the course asks for forwards: '
        'linear.x is positive ahead, and turn to face the way first',
        f'drove {manner.forwards_m:.2f} m forwards where the course says reverse: true',
    ]
    metres = (manner.backwards_m, manner.forwards_m)
    return [line for line, way_m in zip(lines, metres, strict=True) if way_m > ENOUGH_M]
