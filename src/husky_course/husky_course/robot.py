# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The robot as a course sees it: its size seen from above, its name, and where it starts."""

from __future__ import annotations

from dataclasses import dataclass

ROBOT_LENGTH_M = 0.9874  # of the A200's collision box, bumpers included
ROBOT_WIDTH_M = 0.6851


@dataclass(frozen=True, kw_only=True)
class RobotStart:
    """A robot's name and where it starts: metres and radians in the frame `world`."""

    name: str = 'husky'
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
