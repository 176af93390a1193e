# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Collisions: a red flash at the place, with the obstacle's name, and then a small mark."""

from dataclasses import dataclass
from typing import Any

import viser

from husky_sim.view import palette

FLASH_SEC = 2.5
"""Of wall time."""

MOST_MARKS = 50
_FLASH_SCALE = 4.0


@dataclass(frozen=True, kw_only=True)
class Collision:
    """What touched what, where, when and how hard."""

    robot: str
    obstacle: str
    part: str
    time_sec: float
    force_n: float
    position: tuple[float, float, float]

    def __str__(self) -> str:
        return f'{self.obstacle} ({self.part}, {self.force_n:.0f} N) at {self.time_sec:.1f} s'


class CollisionMarks:
    """Shows collisions on the page."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._balls: list[Any] = []
        self._flashing: list[tuple[float, Any, Any]] = []  # when begun, ball, label

    def add(self, collision: Collision, *, now_sec: float) -> None:
        """Flash at a collision; now is of a steady wall clock."""
        if len(self._balls) == MOST_MARKS:
            self._balls.pop(0).remove()
        name = f'/collisions/{collision.robot}_{collision.time_sec:.3f}_{len(self._balls)}'
        ball = self._server.scene.add_icosphere(
            name,
            radius=0.07,
            color=palette.COLLISION,
            position=collision.position,
            scale=_FLASH_SCALE,
            opacity=0.6,
            cast_shadow=False,
        )
        x, y, z = collision.position
        label = self._server.scene.add_label(
            f'{name}_label', f'⚠ {collision}', position=(x, y, z + 0.5), anchor='bottom-center'
        )
        self._balls.append(ball)
        self._flashing.append((now_sec, ball, label))

    def update(self, now_sec: float) -> None:
        """Go on with the flashes; call it with every frame."""
        for begun_sec, ball, label in list(self._flashing):
            age = (now_sec - begun_sec) / FLASH_SEC
            if age >= 1.0:
                ball.scale = 1.0
                label.remove()
                self._flashing.remove((begun_sec, ball, label))
            else:
                pulse = 0.5 + 0.5 * (1.0 if int(age * 10) % 2 == 0 else 0.0)
                ball.scale = 1.0 + (_FLASH_SCALE - 1.0) * (1.0 - age) * pulse

    def clear(self) -> None:
        """Take all of them away."""
        for _, _, label in self._flashing:
            label.remove()
        for ball in self._balls:
            ball.remove()
        self._flashing.clear()
        self._balls.clear()
