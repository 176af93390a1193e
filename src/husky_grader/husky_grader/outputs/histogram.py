# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The distribution of points as an SVG drawing, styled by class.css."""

from collections.abc import Sequence

BARS = 10
WIDTH, HEIGHT = 480, 200
LEFT, RIGHT, TOP, BOTTOM = 18, 18, 24, 28
GAP = 4  # between bars


def histogram(points: Sequence[float], most: float, quartiles: Sequence[float]) -> str:
    """
    Return the drawing: a bar for each tenth of the points, and lines for the quartiles.

    :param most: points that can be had; above 0.
    """
    counts = [0] * BARS
    for value in points:
        # A tenth begins with its lower end; the highest has both.
        counts[min(int(value / most * BARS + 1e-9), BARS - 1)] += 1
    bottom, wide = HEIGHT - BOTTOM, (WIDTH - LEFT - RIGHT) / BARS
    high = (bottom - TOP) / max(counts, default=1)

    def x(value: float) -> float:
        return LEFT + value / most * (WIDTH - LEFT - RIGHT)

    parts, labels = [], []
    for number, count in enumerate(counts):
        left, top = LEFT + number * wide, bottom - count * high
        parts.append(
            f'<rect class="bar" x="{left + GAP / 2:.1f}" y="{top:.1f}" '
            f'width="{wide - GAP:.1f}" height="{bottom - top:.1f}"/>'
        )
        if count:
            labels.append(_text(left + wide / 2, top - 5, f'{count}'))
    labels += [_text(x(most * k / 5), HEIGHT - 8, f'{most * k / 5:g}') for k in range(6)]
    parts += [
        f'<line class="{css}" x1="{x(value):.1f}" x2="{x(value):.1f}" y1="{TOP}" y2="{bottom}"/>'
        for css, value in zip(('quartile', 'median', 'quartile'), quartiles, strict=True)
    ]
    return (
        f'<svg class="plot" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="how many students have how many points">{"".join(parts + labels)}</svg>'
    )


def _text(x: float, y: float, text: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle">{text}</text>'
