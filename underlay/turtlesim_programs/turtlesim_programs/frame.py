# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""All turtles and what they have drawn."""

from __future__ import annotations

from dataclasses import dataclass

from turtlesim_programs.canvas import Canvas
from turtlesim_programs.motion import Colour, SIDE_M, Step, Turtle

KINDS = 11
"""How many looks turtles have: as many as upstream has pictures."""

MIDDLE = SIDE_M / 2


class TurtleError(Exception):
    """A turtle cannot be added or taken away; the message is upstream's."""


@dataclass(frozen=True)
class Seen:
    """What a step has done to a turtle, and the colour that it saw under itself."""

    step: Step
    colour: Colour


class TurtleFrame:
    """Turtles by name, on one canvas."""

    def __init__(self) -> None:
        self.canvas = Canvas()
        self.turtles: dict[str, Turtle] = {}
        self.kinds: dict[str, int] = {}
        self._numbered = 0
        self._spawned = 0

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """
        Add a turtle and return its name.

        :param name: empty: the next free one of turtle1, turtle2 and so on.
        :raises TurtleError: if there is one of this name.
        """
        if name in self.turtles:
            raise TurtleError(f'A turtle named [{name}] already exists')
        name = name or self._free_name()
        self.turtles[name] = Turtle(x, y, theta)
        # Upstream throws dice for the look; here the same spawns give the same picture.
        self.kinds[name] = self._spawned % KINDS
        self._spawned += 1
        return name

    def kill(self, name: str) -> None:
        """
        Take a turtle away; what it has drawn stays.

        :raises TurtleError: if there is none of this name.
        """
        if name not in self.turtles:
            raise TurtleError(f'Tried to kill turtle [{name}], which does not exist')
        del self.turtles[name], self.kinds[name]

    def reset(self) -> None:
        """Take all turtles and lines away, and begin with the names anew."""
        self.turtles.clear()
        self.kinds.clear()
        self._numbered = self._spawned = 0
        self.canvas.clear()

    def step(self, now_sec: float) -> dict[str, Seen]:
        """Move every turtle for a period, in the order of their names."""
        return {name: self._step(self.turtles[name], now_sec) for name in sorted(self.turtles)}

    def _step(self, turtle: Turtle, now_sec: float) -> Seen:
        step = turtle.step(now_sec)
        for line in step.jumps:
            self.canvas.draw(line)
        colour = self.canvas.colour_at((turtle.x, turtle.y))  # before it draws there itself
        if step.way:
            self.canvas.draw(step.way)
        return Seen(step, colour)

    def _free_name(self) -> str:
        while True:
            self._numbered += 1
            if (name := f'turtle{self._numbered}') not in self.turtles:
                return name
