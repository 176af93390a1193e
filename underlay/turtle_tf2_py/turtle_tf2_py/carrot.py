# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A frame that hangs at the first turtle."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node
from rclpy.time import Time
from tf2_py.motions import Vector
from tf2_ros import TransformBroadcaster

from turtle_tf2_py.frames import placed

PERIOD_SEC = 0.1


class Carrot(Node):
    """
    Tells ten times a second where carrot1 is in turtle1.

    :param place: returns where it is at a time, metres.
    """

    def __init__(self, name: str, place: Callable[[Time], Vector]) -> None:
        super().__init__(name)
        self._place = place
        self._broadcaster = TransformBroadcaster(self)
        self.create_timer(PERIOD_SEC, self._on_timer)

    def _on_timer(self) -> None:
        now = self.get_clock().now()
        self._broadcaster.sendTransform(
            placed('turtle1', 'carrot1', self._place(now), stamp=now.to_msg())
        )
