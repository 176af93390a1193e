# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The reasons for a score: what went wrong in a run, and which mistake may have caused it."""

from collections.abc import Sequence
from dataclasses import replace
import math

from husky_course.frames import Array, wrapped
from husky_course.record import Disturbance, Run
from husky_course.route import Route
from husky_course.waypoints import Course
import numpy as np

from husky_grader.scoring.alignment import Frame, mistaken_frames, waypoints_in_order
from husky_grader.scoring.measurement import (
    ENOUGH_M,
    Measurement,
    STANDING_M_S,
    STANDING_RAD_S,
)

COMMANDS = {'lab': 'husky_velocity_controller/cmd_vel', 'clearpath': 'cmd_vel'}
"""The topic of commands that is told, by interface."""

MAX_LINES = 4  # of one kind
MOVED_M = 0.05

FAR_M = 0.5  # off the path by so much, it is worth guessing
NEAR_M = 0.3
DRIVEN_M = 2.0
DEGREES_RAD_S = 6.3  # a whole turn a second: meant were degrees
ROUNDS = 2.0
ORDER_SHARE = 0.8  # of the waypoints but the first, where every run begins

FRAMES: dict[str, Frame] = {
    'mirrored: y is to the left of the Husky, not to its right': lambda x, y: (x, -y),
    'with x and y swapped: x is forward, y is to the left': lambda x, y: (y, x),
    'turned by 180 degrees: x is forward, not backward': lambda x, y: (-x, -y),
    'turned by 90 degrees to the left: x is forward, y is to the left': lambda x, y: (y, -x),
    'turned by 90 degrees to the right: x is forward, y is to the left': lambda x, y: (-y, x),
}


def reasons_for(run: Run, route: Route, measured: Measurement, interface: str) -> tuple[str, ...]:
    """Return one line for each thing that went wrong, most important first."""
    course = route.course
    first = [*disturbance_lines(run), *_early_end(run)]
    if not _moved(run) and not measured.completed:
        # Nobody knows what came after a record broke off: its first two seconds are one block.
        found = [_why_still(run, interface)] if run.complete else []
    else:
        found = [*_collisions(run), *_overturn(run), *_missed(run, course, measured.visits)]
        found += _ending(run, course, all(measured.visits)) if run.complete else []
        wrong_way = _wrong_way(run, measured)
        found = [*wrong_way, *found] if measured.wrong_way > 0.5 else [*found, *wrong_way]
    guesses = [] if all(measured.visits) else _guesses(run, route, measured)
    return (*first, *found, *guesses)


def disturbance_lines(run: Run) -> list[str]:
    """Return one line for each time that others published topics of the run."""
    return _shortened([_disturbance(entry) for entry in run.disturbances], 'disturbances')


def _disturbance(entry: Disturbance) -> str:
    return f'disturbed at {entry.time_sec:.2f} s: {disturbed_by(entry)}'


def disturbed_by(entry: Disturbance, *, names_nodes: bool = True) -> str:
    """
    Return who published what, and why that makes a run worth nothing.

    :param names_nodes: by these, chosen while it drives, a program could tell of its course.
    """
    names, topic = ' and '.join(entry.nodes), entry.topic
    if topic.endswith('/cmd_vel'):  # of these nodes, one is the driver
        both = f'{names} {"both" if len(entry.nodes) == 2 else "all"}'
        several = both if names_nodes else 'several programs'
        return f'{several} published {topic}: nobody can tell whose drive it was'
    who = names if names_nodes else 'a program'
    return f'{who} published {topic} beside the simulator: nobody can tell what the driver heard'


def _early_end(run: Run) -> list[str]:
    if run.complete:
        return []
    return [
        f'the run ended early: its record breaks off at {run.time_sec[-1]:.2f} s, as when the '
        'simulator is killed or the disk is full'
    ]


def _moved(run: Run) -> bool:
    return bool(np.hypot(run.x - run.x[0], run.y - run.y[0]).max() > MOVED_M)


def _why_still(run: Run, interface: str) -> str:
    if not run.command_speed_m_s.any() and not run.command_yaw_rate_rad_s.any():
        return (
            f'it never moved: no command that moves it arrived on {COMMANDS[interface]}; check '
            'the topic name, the message type and the values, and that the node spins'
        )
    if not run.command_speed_m_s.any():
        return 'it never moved from its place: it was only told to turn (linear.x was always 0)'
    return 'it never moved, although it was told to; was it told again every 0.25 s?'


def _collisions(run: Run) -> list[str]:
    lines = [
        f'touched {touch.obstacle} with its {touch.part.replace("_", " ")} at '
        f'{touch.time_sec:.2f} s, with {touch.force_n:.0f} N'
        for touch in run.collisions
    ]
    return _shortened(lines, 'collisions')


def _overturn(run: Run) -> list[str]:
    if run.turned_over_sec is None:
        return []
    at = min(int(np.searchsorted(run.time_sec, run.turned_over_sec - 1e-9)), len(run.x) - 1)
    return [
        f'turned over at {run.turned_over_sec:.2f} s at ({run.x[at]:.2f}, {run.y[at]:.2f}), '
        'as when it climbs an obstacle'
    ]


def _missed(run: Run, course: Course, reached: Sequence[bool]) -> list[str]:
    lines = []
    for number, (point, got) in enumerate(zip(course.stops, reached, strict=True)):
        if got:
            continue
        nearest = float(np.hypot(run.x - point.x_m, run.y - point.y_m).min())
        name = f'waypoint {number + 1} at ({point.x_m:g}, {point.y_m:g})'
        if nearest > course.tolerance_m:
            digits = 2 if nearest >= course.tolerance_m + 0.005 else 4  # or both look the same
            why = f'it came no nearer than {nearest:.{digits}f} m, '
            why += f'allowed are {course.tolerance_m:g} m'
        elif number == len(course.waypoints) and _end_away_m(run, course) > course.tolerance_m:
            why = 'a loop is to end there'
        else:
            why = 'it was there, but not in its turn'
        lines.append(f'missed {name}: {why}')
    return _shortened(lines, 'waypoints')


def _shortened(lines: list[str], what: str) -> list[str]:
    if len(lines) <= MAX_LINES:
        return lines
    return [*lines[: MAX_LINES - 1], f'... and {len(lines) - MAX_LINES + 1} more {what}']


def _ending(run: Run, course: Course, all_reached: bool) -> list[str]:
    speed, yaw_rate, away = run.speed_m_s[-1], run.yaw_rate_rad_s[-1], _end_away_m(run, course)
    if abs(speed) > STANDING_M_S:
        return [f'did not stop: still driving {speed:.2f} m/s when the run ended']
    if abs(yaw_rate) > STANDING_RAD_S:
        return [f'did not stop: still turning {yaw_rate:.2f} rad/s when the run ended']
    if away > course.tolerance_m:
        place = f'({run.x[-1]:.2f}, {run.y[-1]:.2f})'
        how = 'drove on and stopped' if all_reached else 'stopped'
        return [f'{how} at {place}, {away:.2f} m from the last waypoint']
    return []


def _end_away_m(run: Run, course: Course) -> float:
    last = course.stops[-1]
    return math.hypot(run.x[-1] - last.x_m, run.y[-1] - last.y_m)


def _wrong_way(run: Run, measured: Measurement) -> list[str]:
    """Return what was driven against what was asked; who is only pushed there made no mistake."""
    if measured.wrong_way == 0.0:
        return []
    lines = [
        f'drove {measured.backwards_m:.2f} m backwards where the course asks for forwards: '
        'linear.x is positive ahead, and turn to face the way first',
        f'drove {measured.forwards_m:.2f} m forwards where the course says reverse: true',
    ]
    backwards, forwards = run.command_speed_m_s.min() < 0.0, run.command_speed_m_s.max() > 0.0
    metres = (measured.backwards_m * backwards, measured.forwards_m * forwards)
    return [line for line, way_m in zip(lines, metres, strict=True) if way_m > ENOUGH_M]


def _guesses(run: Run, route: Route, measured: Measurement) -> list[str]:
    """Return typical mistakes that leave such a run; nothing where none fits."""
    course, units, lines = route.course, _units(run), _rounds(run, route)
    back = waypoints_in_order(run, replace(course, waypoints=course.waypoints[::-1]))
    enough = max(measured.waypoints_reached, ORDER_SHARE * (len(back) - 1))
    if sum(back) > enough and _moved(run):
        lines.append(
            'it drove the course from its end to its beginning: keep the order of the file'
        )
    if lines or measured.cross_track_rms_m < FAR_M or measured.driven_m < DRIVEN_M:
        return [*units, *lines]
    rms_m = mistaken_frames(run, route.curve, FRAMES)
    best = min(rms_m, key=rms_m.__getitem__)
    likely = rms_m[best] < min(measured.cross_track_rms_m / 2, NEAR_M)
    return [f'it drove the course {best}', *units] if likely else units


def _units(run: Run) -> list[str]:
    fastest = _greatest(run.command_yaw_rate_rad_s)
    if abs(fastest) > DEGREES_RAD_S:
        return [
            f'it commanded angular.z = {fastest:g}: that is rad/s, not degrees; '
            'the Husky turns 2 rad/s at most'
        ]
    speed = _greatest(run.command_speed_m_s)
    if abs(speed) > 3.0:
        return [f'it commanded linear.x = {speed:g}: that is m/s; the Husky drives 1 m/s at most']
    return []


def _greatest(values: Array) -> float:
    return float(values[np.abs(values).argmax()])


def _rounds(run: Run, route: Route) -> list[str]:
    """Name surplus turns, which degrees in the place of radians cause."""
    turns = np.diff(run.yaw)
    turned = float(np.abs(turns - 2 * math.pi * np.rint(turns / (2 * math.pi))).sum())
    extra = (turned - _needed_rad(route)) / (2 * math.pi)
    if extra < ROUNDS:
        return []
    return [
        f'it turned {extra:.1f} rounds more than the path does: angles are in radians, and an '
        'angle between two headings must be brought back to -pi..pi'
    ]


def _needed_rad(route: Route) -> float:
    """Return how much the course turns the robot, on its legs and on the spot."""
    needed, yaw = 0.0, 0.0
    for leg in route.legs:
        needed += abs(wrapped(leg.begin_yaw_rad - yaw))
        needed += float(np.abs(np.diff(leg.curve.heading)).sum())
        yaw = leg.arrival_yaw_rad
        if leg.end_yaw_rad is not None:
            needed += abs(wrapped(leg.end_yaw_rad - yaw))
            yaw = leg.end_yaw_rad
    return needed
