# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Collisions in the scene: a red flash at the place, and then a pin."""

from typing import Any, NamedTuple

from husky_course.record import Collision
import viser

from husky_view.picture import palette

FLASH_SEC = 2.5
"""Of wall time."""

MOST_COLLISIONS = 50
PIN_M = 1.2
"""Height of a collision's pin: lower, walls and the robot would hide it."""

_BALL_M = 0.08
_FLASH_SCALE = 4.0


class _Flash(NamedTuple):
    begun_sec: float
    ball: Any
    label: Any
    obstacle: str


class CollisionMarks:
    """Collisions: a red flash at the place, and then a pin with the obstacle's name."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._nodes: list[Any] = []
        self._flashing: list[_Flash] = []
        self.count = 0

    def add(self, collision: Collision, *, now_sec: float) -> None:
        """Flash at a collision; now is of a steady wall clock. Only the first 50 are drawn."""
        self.count += 1
        if self.count > MOST_COLLISIONS:
            return
        name = f'/collisions/{self.count}'
        scene, (x, y, z) = self._server.scene, collision.position
        pole = scene.add_cylinder(
            f'{name}/pole',
            radius=0.02,
            height=PIN_M,
            color=palette.COLLISION,
            position=(x, y, z + PIN_M / 2.0),
            cast_shadow=False,
        )
        ball = scene.add_icosphere(
            f'{name}/ball',
            radius=_BALL_M,
            color=palette.COLLISION,
            position=(x, y, z + PIN_M),
            scale=_FLASH_SCALE,
            cast_shadow=False,
        )
        label = scene.add_label(
            f'{name}/label',
            f'⚠ {collision}',
            position=(x, y, z + PIN_M + _BALL_M),
            anchor='bottom-center',
        )
        self._nodes += [pole, ball, label]
        self._flashing.append(_Flash(now_sec, ball, label, collision.obstacle))

    def update(self, now_sec: float) -> None:
        """Animate the flashes; call it with every frame."""
        for flash in list(self._flashing):
            age = (now_sec - flash.begun_sec) / FLASH_SEC
            if age >= 1.0:
                flash.ball.scale = 1.0
                flash.label.text = f'⚠ {flash.obstacle}'
                flash.label.font_screen_scale = 0.7
                self._flashing.remove(flash)
            else:
                pulse = 1.0 if int(age * 10) % 2 == 0 else 0.5
                flash.ball.scale = 1.0 + (_FLASH_SCALE - 1.0) * (1.0 - age) * pulse

    def clear(self) -> None:
        """Remove all of them."""
        for node in self._nodes:
            node.remove()
        self._nodes.clear()
        self._flashing.clear()
        self.count = 0
