# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How a turtle moves: a pure function of its commands and the time.

Positions are in metres from the corner at the bottom left. The order of the steps, and that a
step is of a fixed length whatever the clock says, are those of upstream's turtlesim.
"""

from __future__ import annotations

from dataclasses import dataclass, field
import math

import numpy as np

PIXELS = 500
"""Each side of the picture."""

PIXELS_PER_M = 45
SIDE_M = float(np.float32((PIXELS - 1) / PIXELS_PER_M))  # in single precision, as upstream has it
PERIOD_SEC = 0.016
COMMAND_SEC = 1.0
"""How long a command counts."""

ROTATION_RAD_S = 1.0
REACHED_RAD = 0.02

Point = tuple[float, float]
Colour = tuple[int, int, int]


@dataclass(frozen=True)
class Pen:
    colour: Colour = (0xB3, 0xB8, 0xFF)
    width: int = 3  # pixels


@dataclass(frozen=True)
class Line:
    """What a pen draws, from point to point."""

    start: Point
    end: Point
    pen: Pen


@dataclass
class Rotation:
    """A turn towards a direction."""

    theta: float
    start: float
    remaining: float = 0.0
    delta: float = 0.0  # from the direction now back to that of the start
    reached: bool = False


@dataclass(frozen=True)
class Teleport:
    """A jump: to a place, or, where it is relative, ahead after a turn."""

    theta: float
    place: Point = (0.0, 0.0)
    ahead: float = 0.0
    relative: bool = False


@dataclass(frozen=True)
class Step:
    """What has happened in a step: lines of jumps, the line of the way, whether anything moved."""

    jumps: tuple[Line, ...]
    way: Line | None
    moved: bool
    outside: Point | None  # where a wall has held the turtle back from


@dataclass
class Turtle:
    """A turtle; every method but `step` says what the next step is to do."""

    x: float
    y: float
    theta: float
    pen: Pen | None = field(default_factory=Pen)  # None: it draws nothing
    rotation: Rotation | None = None
    linear_x: float = 0.0
    linear_y: float = 0.0
    angular: float = 0.0
    _commanded_sec: float = 0.0
    _teleports: list[Teleport] = field(default_factory=list)

    def command(self, linear: Point, angular: float, now_sec: float) -> None:
        """Move with these velocities for as long as a command counts, instead of a rotation."""
        self.rotation = None
        self.linear_x, self.linear_y = linear
        self.angular = angular
        self._commanded_sec = now_sec

    def teleport(self, jump: Teleport) -> None:
        self._teleports.append(jump)

    def rotate_to(self, theta: float) -> Rotation:
        """Turn towards a direction, and return what the steps tell of it."""
        self.rotation = Rotation(theta, self.theta)
        return self.rotation

    def stop(self) -> None:
        self.rotation = None
        self.linear_x = self.linear_y = self.angular = 0.0

    @property
    def speed(self) -> float:
        return math.hypot(self.linear_x, self.linear_y)

    def step(self, now_sec: float) -> Step:
        """Move for a period."""
        theta_before = self.theta
        jumps = [line for jump in self._teleports if (line := self._jump(jump))]
        jumped = bool(self._teleports)
        self._teleports.clear()
        if self.rotation:
            self._turn(self.rotation, now_sec)
        if now_sec - self._commanded_sec > COMMAND_SEC:
            self.stop()
        before = (self.x, self.y)
        outside = self._advance()
        way = self._line(before) if (self.x, self.y) != before else None
        moved = jumped or self.theta != theta_before or (self.x, self.y) != before
        return Step(tuple(jumps), way, moved, outside)

    def _jump(self, jump: Teleport) -> Line | None:
        before = (self.x, self.y)
        if jump.relative:
            self.theta += jump.theta
            self.x += math.cos(self.theta) * jump.ahead
            self.y += math.sin(self.theta) * jump.ahead
        else:
            self.x, self.y = jump.place[0], min(jump.place[1], SIDE_M)
            self.theta = jump.theta
        return self._line(before)

    def _turn(self, rotation: Rotation, now_sec: float) -> None:
        theta = _wrapped(rotation.theta)
        rotation.remaining = _wrapped(theta - _single(self.theta))
        rotation.delta = _wrapped(_single(rotation.start - self.theta))
        if abs(_wrapped(_single(self.theta) - theta)) < REACHED_RAD:
            rotation.reached = True
            self.stop()
        else:
            self.command((0.0, 0.0), math.copysign(ROTATION_RAD_S, rotation.remaining), now_sec)
            self.rotation = rotation

    def _advance(self) -> Point | None:
        """Move, and return where the turtle would be if there was no wall."""
        self.theta = _wrapped(self.theta + self.angular * PERIOD_SEC)
        cos, sin = math.cos(self.theta), math.sin(self.theta)
        self.x += (cos * self.linear_x - sin * self.linear_y) * PERIOD_SEC
        self.y += (cos * self.linear_y + sin * self.linear_x) * PERIOD_SEC
        wanted = (self.x, self.y)
        self.x, self.y = (min(max(value, 0.0), SIDE_M) for value in wanted)
        return wanted if (self.x, self.y) != wanted else None

    def _line(self, start: Point) -> Line | None:
        return Line(start, (self.x, self.y), self.pen) if self.pen else None


def _wrapped(angle: float) -> float:
    """Return an angle between -pi and pi."""
    angle = math.fmod(angle, math.tau)  # changes nothing but what has turned more than once
    return angle - math.tau * math.floor((angle + math.pi) / math.tau)


def _single(value: float) -> float:
    """Return a number in single precision: it decides when upstream's rotation is over."""
    return float(np.float32(value))
