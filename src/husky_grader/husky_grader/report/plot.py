# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Draw curves over time as SVG text that a page can hold."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
import math

WIDTH, HEIGHT = 480, 200
LEFT, RIGHT, TOP, BOTTOM = 46, 12, 10, 28
MAX_POINTS = 700
TICKS = 5  # about so many on an axis


@dataclass(frozen=True)
class Plot:
    """Curves by their CSS class, a band that is good, and moments to mark."""

    title: str
    times: Sequence[float]
    curves: Mapping[str, Sequence[float]]
    good: tuple[float, float] | None = None
    moments: Sequence[float] = field(default=())

    def svg(self) -> str:
        """Return the drawing."""
        every = max(1, len(self.times) // MAX_POINTS)
        times = self.times[::every]
        curves = {css: values[::every] for css, values in self.curves.items()}
        seen = [*(value for values in curves.values() for value in values), *(self.good or ())]
        rows, columns = ticks(min(*seen, 0.0), max(*seen, 0.05)), ticks(times[0], times[-1])
        low, high = rows[0], rows[-1]
        begin, span = times[0], max(times[-1] - times[0], 1e-9)

        def x(time: float) -> float:
            return LEFT + (time - begin) / span * (WIDTH - LEFT - RIGHT)

        def y(value: float) -> float:
            return TOP + (high - value) / (high - low) * (HEIGHT - TOP - BOTTOM)

        parts = [_band(y(self.good[1]), y(self.good[0]))] if self.good else []
        parts += [_row(y(value), _text(value, rows)) for value in rows]
        parts += [
            _column(x(t), _text(t, columns)) for t in columns if -0.01 < (t - begin) / span <= 1.0
        ]
        for css, values in curves.items():
            points = ' '.join(f'{x(t):.1f},{y(v):.1f}' for t, v in zip(times, values, strict=True))
            parts.append(f'<polyline class="{css}" points="{points}"/>')
        parts += [
            f'<line class="moment" x1="{x(t):.1f}" x2="{x(t):.1f}" y1="{TOP}" '
            f'y2="{HEIGHT - BOTTOM}"/>'
            for t in self.moments
        ]
        return (
            f'<svg class="plot" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
            f'aria-label="{escape(self.title)}">{"".join(parts)}</svg>'
        )


def ticks(low: float, high: float) -> list[float]:
    """Return round values, evenly spaced, of which the outer ones enclose low and high."""
    rough = max(high - low, 1e-9) / TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= rough)
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [k * step for k in range(first, max(last, first + 1) + 1)]


def _text(value: float, among: Sequence[float]) -> str:
    places = max(0, -math.floor(math.log10(among[1] - among[0]) + 1e-9))
    return f'{value:.{places}f}'


def _band(top: float, bottom: float) -> str:
    return (
        f'<rect class="good" x="{LEFT}" y="{top:.1f}" width="{WIDTH - LEFT - RIGHT}" '
        f'height="{bottom - top:.1f}"/>'
    )


def _row(y: float, text: str) -> str:
    return (
        f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'
        f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{text}</text>'
    )


def _column(x: float, text: str) -> str:
    return f'<text x="{x:.1f}" y="{HEIGHT - 8}" text-anchor="middle">{text}</text>'
