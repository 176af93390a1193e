# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A waypoint file while it is edited: points in the frame odom, and the text they become."""

from dataclasses import dataclass, field, replace
import math

UNDO = 100
NEAR_M = 0.3
"""A click nearer than this to a waypoint means that waypoint."""


@dataclass(frozen=True)
class Point:
    """
    A waypoint; x and y in whole centimetres, as they are written.

    :param more: other fields of the file, as name and text: kept as they are.
    """

    x: float
    y: float
    more: tuple[tuple[str, str], ...] = ()

    def __str__(self) -> str:
        if not self.more:
            return f'[{self.x:.2f}, {self.y:.2f}]'
        more = ''.join(f', {name}: {text}' for name, text in self.more)
        return f'{{x: {self.x:.2f}, y: {self.y:.2f}{more}}}'


@dataclass(frozen=True)
class Content:
    """What a draft holds at one moment."""

    points: tuple[Point, ...] = ()
    speed_m_s: float = 0.5
    tolerance_m: float = 0.25
    loop: bool = False
    corners: str = 'smooth'


@dataclass
class Draft:
    """Changes to waypoints, which can be taken back."""

    content: Content = field(default_factory=Content)
    selected: int | None = None
    _past: list[Content] = field(default_factory=list)

    def _change(self, content: Content) -> None:
        self._past = [*self._past[1 - UNDO :], self.content]
        self.content = content

    def add(self, x: float, y: float) -> None:
        """Append a waypoint and select it."""
        points = (*self.content.points, Point(_whole(x), _whole(y)))
        self._change(replace(self.content, points=points))
        self.selected = len(points) - 1

    def begin_move(self, number: int) -> None:
        """Remember where everything was, so that a whole drag is taken back at once."""
        self._change(self.content)
        self.selected = number

    def move(self, number: int, x: float, y: float) -> None:
        """Put a waypoint somewhere else."""
        points = list(self.content.points)
        points[number] = replace(points[number], x=_whole(x), y=_whole(y))
        self.content = replace(self.content, points=tuple(points))

    def delete_selected(self) -> None:
        """Remove the selected waypoint, or else the last one."""
        points = list(self.content.points)
        if points:
            del points[self.selected if self.selected is not None else -1]
            self._change(replace(self.content, points=tuple(points)))
            self.selected = None

    def clear(self) -> None:
        """Remove all waypoints."""
        self._change(replace(self.content, points=()))
        self.selected = None

    def set(self, *, speed_m_s: float, loop: bool) -> None:
        """Change what holds for the whole course."""
        self._change(replace(self.content, speed_m_s=speed_m_s, loop=loop))

    def load(self, content: Content) -> None:
        """Take what a file holds."""
        self._change(content)
        self.selected = None

    def undo(self) -> None:
        """Take the last change back."""
        if self._past:
            self.content = self._past.pop()
            self.selected = None

    def nearest(self, x: float, y: float) -> int | None:
        """Return the waypoint that a click means, if any."""
        distances = [math.hypot(p.x - x, p.y - y) for p in self.content.points]
        if not distances or min(distances) > NEAR_M:
            return None
        return distances.index(min(distances))

    def text(self) -> str:
        """Return the waypoint file."""
        content = self.content
        corners = '' if content.corners == 'smooth' else f'corners: {content.corners}\n'
        return (
            '# Made with the editor of the view.\n'
            'frame: odom         # metres, x forward and y left of where the Husky starts\n'
            f'speed: {content.speed_m_s:<12g} # m/s along the path, up to 1.0\n'
            f'tolerance: {content.tolerance_m:<8g} # m, how near counts as reached\n'
            f'loop: {"true " if content.loop else "false"}         '
            '# true: come back to the first waypoint\n'
            f'{corners}waypoints:\n' + ''.join(f'  - {point}\n' for point in content.points)
        )


def _whole(length_m: float) -> float:
    return round(length_m, 2) + 0.0  # no -0.0
