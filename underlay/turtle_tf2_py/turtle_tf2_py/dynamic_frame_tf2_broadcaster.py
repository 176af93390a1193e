# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Hang a carrot at the first turtle, on one side in one second, on the other in the next."""

from __future__ import annotations

import math
import sys

from node_program import run_node
from rclpy.time import Time
from tf2_py.motions import Vector

from turtle_tf2_py.carrot import Carrot

NAME = 'dynamic_frame_tf2_broadcaster'
RADIUS_M = 10.0


def place(now: Time) -> Vector:
    """Return where it is; as upstream's it goes round by whole seconds, half a turn in each."""
    seconds, _ = now.seconds_nanoseconds()
    angle = seconds * math.pi
    return RADIUS_M * math.sin(angle), RADIUS_M * math.cos(angle), 0.0


def main(argv: list[str] | None = None) -> int:
    return run_node(lambda _: Carrot(NAME, place), sys.argv if argv is None else argv)


if __name__ == '__main__':
    sys.exit(main())
