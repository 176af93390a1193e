# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The step in which the lab's driver follows a waypoint file that was handed in."""

from collections.abc import Callable
from pathlib import Path

from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
import numpy as np

from husky_grader.file_grading import grade_file
from husky_grader.lab.drive_step import exceeded, passed
from husky_grader.lab.finding import Finding, nothing
from husky_grader.rubric.steps import PathStep, Place
from husky_grader.scoring.report import digits_apart


def path_step(
    step: PathStep, file: Path, folder: Path, *, world: str, alive: Callable[[], object]
) -> Finding:
    """
    Drive the course of a file in the simulator.

    :param folder: of the whole report; the drive gets a folder of its own in it.
    :param world: MJCF file; empty: the playpen.
    :param alive: called with every second of simulated time.
    """
    grade = grade_file(str(file), folder / step.file_name, world=world, each_second=alive)
    if grade.report is None:
        return nothing(grade.refused.replace(f'{file}: ', '').replace('\n', '; '))
    report = grade.report
    defects = exceeded(
        step.limits,
        collisions=len(report['collisions']),
        off_path_m=report['cross_track_rms_m'],
        time_sec=report['sim_time_sec'],
    )
    if left_out := _left_out(step, plan_route(load_course(file))):
        defects['passes'] = left_out
    why = '; '.join(report['reasons']) or passed(
        report['course'], {part['why']: part['cost_points'] for part in report['parts']}
    )
    if defects:
        last = list(defects)[-1]
        defects[last] = f'{defects[last]}; {why}'  # once, of however many there are
    return Finding(why, score=report['score'], defects=defects)


def _left_out(step: PathStep, route: Route) -> str:
    """Return in words the first point that the path does not pass in its turn; or nothing."""
    x, y = np.asarray(route.curve.x), np.asarray(route.curve.y)
    begin = 0
    for place in step.passes:
        away_m = np.hypot(x[begin:] - place.x, y[begin:] - place.y)
        near = np.flatnonzero(away_m <= step.within_m)
        if not len(near):
            return f'the path leaves out {_told(place)}: {_how(away_m, step.within_m, begin)}'
        begin += int(near[0])
    return ''


def _told(place: Place) -> str:
    return f'({place.x:g}, {place.y:g})'


def _how(
    away_m: 'np.ndarray[tuple[int, ...], np.dtype[np.float64]]', most_m: float, begin: int
) -> str:
    after = ' after the point before it' if begin else ''
    least_m = float(away_m.min())
    digits = digits_apart(least_m, most_m, least=2)
    return f'it comes no nearer than {least_m:.{digits}f} m{after}, allowed are {most_m:g} m'
