# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Place a frame in the world that stands still."""

from __future__ import annotations

import math
import sys

from node_program import own_words, refuse, run_node
from rclpy.node import Node
from tf2_py.motions import of_angles
from tf2_ros import StaticTransformBroadcaster

from turtle_tf2_py.frames import placed, WORLD

_USAGE = 'static_turtle_tf2_broadcaster child_frame_name x y z roll pitch yaw'
WRONG_COUNT = 1


class StaticFramePublisher(Node):
    """
    Tells once where the frame is, also those who come later.

    :param numbers: x, y, z in metres; roll, pitch, yaw in radians.
    """

    def __init__(self, child_frame: str, numbers: list[float]) -> None:
        super().__init__('static_turtle_tf2_broadcaster')
        x, y, z, roll, pitch, yaw = numbers
        now = self.get_clock().now().to_msg()
        self._broadcaster = StaticTransformBroadcaster(self)
        self._broadcaster.sendTransform(
            placed(WORLD, child_frame, (x, y, z), of_angles(roll, pitch, yaw), stamp=now)
        )


def main(argv: list[str] | None = None) -> int:
    argv = sys.argv if argv is None else argv
    words = own_words(argv)
    if len(words) != 7:
        refuse(f'{len(words)} words are given, and 7 are needed: {_USAGE}')
        return WRONG_COUNT
    child_frame, *texts = words
    if child_frame == WORLD:
        return refuse(f"the frame '{WORLD}' is the one that it is placed in: give another name")
    try:
        numbers = [float(text) for text in texts]
    except ValueError as error:
        return refuse(f'{error}: {_USAGE}')
    if not all(map(math.isfinite, numbers)):
        return refuse(f'{" ".join(texts)}: they must be finite numbers')
    return run_node(lambda _: StaticFramePublisher(child_frame, numbers), argv)


if __name__ == '__main__':
    sys.exit(main())
