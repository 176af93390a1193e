# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Relate a run to its course: the place on the path of every pose, and the waypoints reached.

The nearest point of the path alone would jump where a course crosses or comes back to itself.
`align` lets places on the path only go forward in time, and takes the way with the least squared
distance (dynamic time warping with free steps along the path, by dynamic programming).
"""

from bisect import bisect_left
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
import math

from husky_course.frames import Array, Indices
from husky_course.record import Run
from husky_course.route import AT_FIRST_M, Curve, Route
from husky_course.waypoints import Course, Waypoint
import numpy as np

MAX_POSES = 2500
PATH_STEP_M = 0.05
MAX_PLACES = 2500
CHUNK = 500  # entries, ten seconds: compared with a waypoint by their bounding box first

Frame = Callable[[Array, Array], tuple[Array, Array]]  # from odom into another frame


@dataclass(frozen=True, eq=False)
class Alignment:
    """A run laid along its path: two numbers an entry, and which of `Course.stops` it reached."""

    along_m: Array
    errors_m: Array  # to the left of the path; 0 on the way to its first waypoint
    visits: tuple[bool, ...]
    begin: int  # the entry at which the path begins; 0 where the drive begins there


def align(run: Run, route: Route) -> Alignment:
    """Return the places of a run on its path, and the waypoints that it reached in order."""
    course, counted = route.course, _counted(run, route.course)
    begin = _path_begin(run, course, counted)
    along, errors = _align(route.curve, run.spread(MAX_POSES, begin), run.x, run.y)
    along[:begin], errors[:begin] = along[begin], 0.0
    return Alignment(along, errors, _reached(run, course, counted), begin)


def _path_begin(run: Run, course: Course, counted: Mapping[int, int]) -> int:
    """
    Return the entry at which a run has come to the first waypoint, or nearest to that.

    The way there is none of the path, and may lead along other parts of it.

    :param counted: the waypoints that count as reached, and the entries at which; the path has
        begun before any but the first, so that the end of a loop is not its beginning.
    """
    first = course.waypoints[0]
    later = min((entry for number, entry in counted.items() if number), default=len(run.x))
    away_m = np.hypot(run.x[run.begin :] - first.x_m, run.y[run.begin :] - first.y_m)
    if away_m[0] <= min(course.tolerance_m, AT_FIRST_M):
        return 0
    near = away_m <= max(course.tolerance_m, away_m[: later + 1 - run.begin].min())
    came = int(near.argmax())
    stay = int(np.append(near[came:], False).argmin())  # entries, until it left again
    return run.begin + came + int(away_m[came : came + stay].argmin())


def mistaken_frames(run: Run, curve: Curve, frames: Mapping[str, Frame]) -> dict[str, float]:
    """Return how far the run is off the curve, RMS, if it was driven in one of the frames."""
    picked = run.spread(MAX_POSES)
    offsets = {name: _align(curve, picked, *to(run.x, run.y))[1] for name, to in frames.items()}
    return {name: math.sqrt(float(np.mean(offset**2))) for name, offset in offsets.items()}


def _align(curve: Curve, picked: Indices, x: Array, y: Array) -> tuple[Array, Array]:
    """Return for every pose its place along the curve and its offset to the left of it."""
    places = _places(curve)
    path = np.array([curve.point_at(s) for s in places])
    steps = _best_steps(path, np.stack([x[picked], y[picked]], axis=1))
    near = np.array([curve.index_at(places[step]) for step in steps])
    before = np.searchsorted(picked, np.arange(len(x)), side='right') - 1
    return projected(curve, near[np.maximum(before, 0)], x, y)


def projected(curve: Curve, near: Indices, x: Array, y: Array) -> tuple[Array, Array]:
    """
    Project every pose as `Curve.project` does one, from the samples `near` it.

    Beyond an end or a sharp corner the offset is the distance to that, not to the line on from it.
    """
    xs, ys, s = np.array(curve.x), np.array(curve.y), np.array(curve.s)
    last = len(xs) - 1
    i = near.astype(np.int64)
    best = (xs[i] - x) ** 2 + (ys[i] - y) ** 2
    for step in (1, -1):
        walking = np.arange(len(x))
        while walking.size:
            walking = walking[(i[walking] < last) if step > 0 else (i[walking] > 0)]
            following = i[walking] + step
            away = (xs[following] - x[walking]) ** 2 + (ys[following] - y[walking]) ** 2
            nearer = away <= best[walking] if step > 0 else away < best[walking]
            walking = walking[nearer]
            i[walking], best[walking] = following[nearer], away[nearer]
    foot = _along(xs, ys, np.minimum(i, last - 1), x, y)
    back = ((foot < 0.0) & (i > 0)) | (i == last)
    i[back] = np.maximum(i[back] - 1, 0)
    foot = _along(xs, ys, i, x, y)
    length = s[i + 1] - s[i]
    along = np.clip(foot, 0.0, length)
    dx, dy = (xs[i + 1] - xs[i]) / length, (ys[i + 1] - ys[i]) / length
    aside = dx * (y - ys[i]) - dy * (x - xs[i])
    return s[i] + along, np.copysign(np.hypot(aside, foot - along), aside)


def _along(xs: Array, ys: Array, i: Indices, x: Array, y: Array) -> Array:
    """Return how far past samples `i` the feet of poses are, towards the next samples."""
    dx, dy = xs[i + 1] - xs[i], ys[i + 1] - ys[i]
    return np.asarray(((x - xs[i]) * dx + (y - ys[i]) * dy) / np.hypot(dx, dy))


def _places(curve: Curve) -> list[float]:
    count = min(max(2, round(curve.length_m / PATH_STEP_M) + 1), MAX_PLACES)
    return [curve.length_m * k / (count - 1) for k in range(count)]


def _best_steps(path: Array, poses: Array) -> list[int]:
    """Return the index into the path for each pose: never decreasing, least squares."""
    xs, ys = np.ascontiguousarray(path.T)
    costs = np.empty((len(poses), len(path)))  # of having come to each place, before each pose
    cost = np.zeros(len(path))
    for k, (x, y) in enumerate(poses.tolist()):
        costs[k] = cost
        dx, dy = xs - x, ys - y
        cost = np.minimum.accumulate(cost) + (dx * dx + dy * dy)
    place = int(np.argmin(cost))
    steps = [0] * len(poses)
    for k in range(len(poses) - 1, -1, -1):
        steps[k] = place
        place = int(np.argmin(costs[k, : place + 1]))
    return steps


def waypoints_in_order(run: Run, course: Course) -> tuple[bool, ...]:
    """
    Tell for each of `course.stops` whether the run reached it.

    Of all ways to count waypoints in the order of the course, the one that counts most is taken
    (longest increasing subsequence): one that was left out costs itself, not all that follow.
    The last stop of a loop counts when the run ends there and reached half of the others.
    """
    return _reached(run, course, _counted(run, course))


def _reached(run: Run, course: Course, counted: Mapping[int, int]) -> tuple[bool, ...]:
    reached = [number in counted for number in range(len(course.waypoints))]
    if course.loop:
        first = course.waypoints[0]
        away_m = float(np.hypot(run.x[-1] - first.x_m, run.y[-1] - first.y_m))
        reached.append(away_m <= course.tolerance_m and 2 * sum(reached) >= len(reached))
    return tuple(reached)


def _counted(run: Run, course: Course) -> dict[int, int]:
    """Return the numbers of the waypoints that count as reached, and the entries at which."""
    x, y = run.x[run.begin :], run.y[run.begin :]
    boxes = _boxes(x, y)
    stays = [_stays(boxes, x, y, point, course.tolerance_m) for point in course.waypoints]
    visits = sorted(_visits(stays))
    chain = _longest_increasing([number for _, _, number in visits])
    return {visits[at][2]: run.begin + visits[at][0] for at in chain}


def _visits(stays: Sequence[Indices]) -> Iterator[tuple[int, int, int]]:
    """
    Yield entries at which waypoints may be counted: entry, minus the first of a series, number.

    A stay counts when it begins, or when the waypoint before does: near ones are a series, and
    counted at once. So ordered, two of an entry that are no series come in the wrong order: one
    visit does not count for both ways past a place, and the start not as the end of the course.
    """
    series: dict[int, int] = {}
    for number, ends in enumerate(stays):
        begins, entries = ends[:, 0], np.array([*series], dtype=np.int64)
        within = np.searchsorted(begins, entries, side='right') - 1
        stayed = (within >= 0) & (entries < np.append(ends[:, 1], 0)[within])
        goes_on = {entry: series[entry] for entry in entries[stayed].tolist()}
        series = dict.fromkeys(begins.tolist(), number) | goes_on
        yield from ((entry, -first, number) for entry, first in series.items())


def _boxes(x: Array, y: Array) -> Array:
    """Return the least and greatest x and y of each CHUNK entries, one row each."""
    first = np.arange(0, len(x), CHUNK)
    least, greatest = np.minimum.reduceat, np.maximum.reduceat
    return np.stack([least(x, first), greatest(x, first), least(y, first), greatest(y, first)])


def _stays(boxes: Array, x: Array, y: Array, point: Waypoint, tolerance_m: float) -> Indices:
    """Return rows of the first entry of each stay near a waypoint, and of that after its last."""
    low_x, high_x, low_y, high_y = boxes
    close = (low_x <= point.x_m + tolerance_m) & (high_x >= point.x_m - tolerance_m)
    close &= (low_y <= point.y_m + tolerance_m) & (high_y >= point.y_m - tolerance_m)
    entries: Indices = (np.flatnonzero(close)[:, None] * CHUNK + np.arange(CHUNK)).ravel()
    entries = entries[entries < len(x)]
    away_m = np.hypot(x[entries] - point.x_m, y[entries] - point.y_m)
    near = entries[away_m <= tolerance_m]
    gaps = np.diff(near, prepend=-2, append=len(x) + 1) > 1
    return np.stack([near[gaps[:-1]], near[gaps[1:]] + 1], axis=1)


def _longest_increasing(numbers: Sequence[int]) -> list[int]:
    """Return the places of a longest chain among the numbers, the last one first."""
    tails: list[int] = []  # the smallest last number of a chain of each length
    tail_at: list[int] = []
    before: list[int] = []
    for at, number in enumerate(numbers):
        length = bisect_left(tails, number)
        before.append(tail_at[length - 1] if length else -1)
        if length == len(tails):
            tails.append(number)
            tail_at.append(at)
        else:
            tails[length], tail_at[length] = number, at
    chain = []
    at = tail_at[-1] if tail_at else -1
    while at >= 0:
        chain.append(at)
        at = before[at]
    return chain
