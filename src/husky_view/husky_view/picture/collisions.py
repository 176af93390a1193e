# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Collisions: a red flash at the place, and then a pin with the obstacle's name."""

from typing import Any

from husky_course.record import Collision
import viser

from husky_view.picture import palette

FLASH_SEC = 2.5
"""Of wall time."""

MOST_MARKS = 50
PIN_M = 1.2
"""So high above the place stands what is seen of it, or walls and the robot would hide it."""

_FLASH_SCALE = 4.0


class CollisionMarks:
    """Shows collisions on the page."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._nodes: list[Any] = []
        self._flashing: list[tuple[float, Any, Any, str]] = []  # when begun, ball, label, name
        self._made = 0

    def add(self, collision: Collision, *, now_sec: float) -> None:
        """Flash at a collision; now is of a steady wall clock."""
        if self._made == MOST_MARKS:
            return
        self._made += 1
        name = f'/collisions/{self._made}'
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
            radius=0.08,
            color=palette.COLLISION,
            position=(x, y, z + PIN_M),
            scale=_FLASH_SCALE,
            cast_shadow=False,
        )
        label = scene.add_label(
            f'{name}/label',
            f'⚠ {collision}',
            position=(x, y, z + PIN_M + 0.4),
            anchor='bottom-center',
        )
        self._nodes += [pole, ball, label]
        self._flashing.append((now_sec, ball, label, collision.obstacle))

    def update(self, now_sec: float) -> None:
        """Go on with the flashes; call it with every frame."""
        for flash in list(self._flashing):
            begun_sec, ball, label, obstacle = flash
            age = (now_sec - begun_sec) / FLASH_SEC
            if age >= 1.0:
                ball.scale = 1.0
                label.text = f'⚠ {obstacle}'
                label.font_screen_scale = 0.7
                self._flashing.remove(flash)
            else:
                pulse = 1.0 if int(age * 10) % 2 == 0 else 0.5
                ball.scale = 1.0 + (_FLASH_SCALE - 1.0) * (1.0 - age) * pulse

    def clear(self) -> None:
        """Take all of them away."""
        for node in self._nodes:
            node.remove()
        self._nodes.clear()
        self._flashing.clear()
        self._made = 0
