# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The robot as a course sees it: its size seen from above, its name, and where it starts."""

from __future__ import annotations

from dataclasses import dataclass
import math
import re

from husky_course.frames import Pose

ROBOT_LENGTH_M = 0.9874  # of the A200's collision box, bumpers included
ROBOT_WIDTH_M = 0.6851

_NAME = re.compile(r'[A-Za-z](_?[A-Za-z0-9]){0,59}_?')  # ROS takes no __ in a namespace


@dataclass(frozen=True, kw_only=True)
class RobotStart:
    """A robot's name and where it starts: metres and radians in the frame `world`."""

    name: str = 'husky'
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    @property
    def pose(self) -> Pose:
        """Return x, y and yaw."""
        return self.x, self.y, self.yaw

    @classmethod
    def parse(cls, line: str) -> RobotStart:
        """
        Read a robot from a parameter or a command line: `NAME X Y YAW`.

        :raises ValueError: if it is not of that form.
        """
        name, *pose = line.split() or ['']
        try:
            x, y, yaw = (float(word) for word in pose)
        except ValueError:
            x = y = yaw = math.nan
        if not _NAME.fullmatch(name) or not all(math.isfinite(value) for value in (x, y, yaw)):
            raise ValueError(
                f"{line!r}: a robot is 'NAME X Y YAW', a name of letters, digits and single _ "
                "and three numbers, as in 'husky_beta 1.0 3.0 0.5236'"
            )
        return cls(name=name, x=x, y=y, yaw=yaw)
