# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The smooth curve through waypoints, sampled by arc length.

Centripetal Catmull-Rom (Yuksel, Schaefer, Keyser: "Parameterization and applications of
Catmull-Rom curves", CAD 43, 2011): it goes through every waypoint, and between two of them it
makes neither loops nor cusps.
"""

from bisect import bisect_right
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
import math

STEP_M = 0.02  # between two samples; longer on very long courses
MAX_SAMPLES = 30_000

Point = tuple[float, float]


@dataclass(frozen=True)
class Curve:
    """
    Samples along a curve, all lists of one length.

    Headings are continuous (not wrapped), curvatures are positive to the left, `knot_s` are the
    arc lengths at which the curve passes the points it was made from.
    """

    x: list[float]
    y: list[float]
    s: list[float]
    heading: list[float]
    curvature: list[float]
    knot_s: list[float]

    @property
    def length_m(self) -> float:
        return self.s[-1]

    def index_at(self, s: float) -> int:
        """Return the sample at or before arc length `s`, never the last one."""
        return min(max(bisect_right(self.s, s) - 1, 0), len(self.s) - 2)

    def point_at(self, s: float) -> Point:
        return self._value_at(self.x, s), self._value_at(self.y, s)

    def heading_at(self, s: float) -> float:
        return self._value_at(self.heading, s)

    def _value_at(self, values: list[float], s: float) -> float:
        i = self.index_at(s)
        part = min(max((s - self.s[i]) / (self.s[i + 1] - self.s[i]), 0.0), 1.0)
        return values[i] + part * (values[i + 1] - values[i])

    def project(self, i: int, x: float, y: float) -> tuple[int, float, float]:
        """
        Return the sample before the nearest point, its arc length and the offset to the left.

        Walks downhill from sample `i`: for a point that moves along the curve this follows it
        through crossings and costs a few comparisons.
        """
        xs, ys = self.x, self.y
        last = len(xs) - 1
        best = (xs[i] - x) ** 2 + (ys[i] - y) ** 2
        while i < last and (ahead := (xs[i + 1] - x) ** 2 + (ys[i + 1] - y) ** 2) <= best:
            i, best = i + 1, ahead
        while i > 0 and (behind := (xs[i - 1] - x) ** 2 + (ys[i - 1] - y) ** 2) < best:
            i, best = i - 1, behind
        along = self._along(i, x, y)
        if (along < 0.0 and i > 0) or i == last:
            i -= 1
            along = self._along(i, x, y)
        step = self.s[i + 1] - self.s[i]
        along = min(max(along, 0.0), step)
        dx, dy = (xs[i + 1] - xs[i]) / step, (ys[i + 1] - ys[i]) / step
        offset = dx * (y - ys[i]) - dy * (x - xs[i])
        return i, self.s[i] + along, offset

    def _along(self, i: int, x: float, y: float) -> float:
        """Return how far past sample `i` the foot of (x, y) is, towards the next sample."""
        j = min(i + 1, len(self.x) - 1)
        i = j - 1 if j == i else i
        dx, dy = self.x[j] - self.x[i], self.y[j] - self.y[i]
        return ((x - self.x[i]) * dx + (y - self.y[i]) * dy) / math.hypot(dx, dy)


def smooth_curve(points: Sequence[Point], *, closed: bool = False) -> Curve:
    """
    Return the curve through `points`; when closed, back to the first one.

    :raises ValueError: for fewer than 2 points, or neighbours at the same place.
    """
    if len(points) < 2:
        raise ValueError(f'{len(points)} points: a curve needs at least 2')
    cubics = _cubics(points, closed)
    chords = math.fsum(map(_chord_m, cubics))
    step = max(STEP_M, chords / MAX_SAMPLES)
    curve = Curve([], [], [], [], [], [])
    for cubic in cubics:
        _extend(curve, cubic, step)
    return curve


def joined(curves: Sequence[Curve]) -> Curve:
    """Return curves that continue each other as one."""
    whole = deepcopy(curves[0])
    for curve in curves[1:]:
        begin = whole.length_m
        whole.x.extend(curve.x[1:])
        whole.y.extend(curve.y[1:])
        whole.s.extend(begin + along for along in curve.s[1:])
        whole.heading.extend(curve.heading[1:])
        whole.curvature.extend(curve.curvature[1:])
        whole.knot_s.extend(begin + along for along in curve.knot_s[1:])
    return whole


# One piece of the curve: coefficients of u^0..u^3 for x and for y, u from 0 to 1.
Cubic = tuple[tuple[float, float, float, float], tuple[float, float, float, float]]


def _cubics(points: Sequence[Point], closed: bool) -> list[Cubic]:
    if closed:
        ring = [points[-1], *points, points[0], points[1]]
    else:
        (x0, y0), (x1, y1) = points[0], points[1]
        (xm, ym), (xn, yn) = points[-2], points[-1]
        ring = [(2 * x0 - x1, 2 * y0 - y1), *points, (2 * xn - xm, 2 * yn - ym)]
    return [_cubic(*ring[i : i + 4]) for i in range(len(ring) - 3)]


def _cubic(p0: Point, p1: Point, p2: Point, p3: Point) -> Cubic:
    """Return the piece from p1 to p2; knots are the square roots of the chords."""
    t01, t12, t23 = (math.sqrt(math.dist(a, b)) for a, b in ((p0, p1), (p1, p2), (p2, p3)))
    if min(t01, t12, t23) <= 0.0:
        raise ValueError(f'two neighbouring points at the same place near {p1}')
    axes = []
    for a, b, c, d in zip(p0, p1, p2, p3, strict=True):
        m1 = c - b + t12 * ((b - a) / t01 - (c - a) / (t01 + t12))
        m2 = c - b + t12 * ((d - c) / t23 - (d - b) / (t12 + t23))
        axes.append((b, m1, 3 * (c - b) - 2 * m1 - m2, 2 * (b - c) + m1 + m2))
    return axes[0], axes[1]


def _chord_m(cubic: Cubic) -> float:
    ax, ay = cubic
    return math.hypot(ax[1] + ax[2] + ax[3], ay[1] + ay[2] + ay[3])


def _extend(curve: Curve, cubic: Cubic, step: float) -> None:
    """Add the samples of the next piece."""
    count = max(4, math.ceil(_chord_m(cubic) / step))
    if not curve.x:
        _append(curve, cubic, 0.0, 0.0)
        curve.knot_s.append(0.0)
    for k in range(1, count + 1):
        u = k / count
        _append(curve, cubic, u, _arc_length(cubic, u - 1 / count, u))
    curve.knot_s.append(curve.length_m)


def _append(curve: Curve, cubic: Cubic, u: float, ds: float) -> None:
    (x0, x1, x2, x3), (y0, y1, y2, y3) = cubic
    dx, dy = x1 + u * (2 * x2 + u * 3 * x3), y1 + u * (2 * y2 + u * 3 * y3)
    ddx, ddy = 2 * x2 + 6 * u * x3, 2 * y2 + 6 * u * y3
    heading = math.atan2(dy, dx)
    if curve.heading:
        turn = math.remainder(heading - curve.heading[-1], 2 * math.pi)
        heading = curve.heading[-1] + turn
    curve.x.append(x0 + u * (x1 + u * (x2 + u * x3)))
    curve.y.append(y0 + u * (y1 + u * (y2 + u * y3)))
    curve.s.append((curve.length_m if curve.s else 0.0) + ds)
    curve.heading.append(heading)
    curve.curvature.append((dx * ddy - dy * ddx) / max(dx * dx + dy * dy, 1e-12) ** 1.5)


def _arc_length(cubic: Cubic, a: float, b: float) -> float:
    """Integrate the speed over a short piece by Simpson's rule."""
    (_, x1, x2, x3), (_, y1, y2, y3) = cubic

    def speed(u: float) -> float:
        return math.hypot(x1 + u * (2 * x2 + u * 3 * x3), y1 + u * (2 * y2 + u * 3 * y3))

    return (b - a) / 6 * (speed(a) + 4 * speed((a + b) / 2) + speed(b))
