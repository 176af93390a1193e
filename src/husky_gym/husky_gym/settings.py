# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `gymnasium.make` can be given: the only place where a default of the environment lives."""

from __future__ import annotations

from dataclasses import dataclass
import math
import os
from typing import Any

from husky_runtime.settings import Setting, setting, settings_of
import numpy as np

from husky_sim.config import FLOORS


@dataclass(frozen=True, kw_only=True)
class EnvironmentSettings:
    """Metres, radians and seconds; poses in the frame `world`, courses in `odom`."""

    course: str = setting('', 'Waypoint file; empty: once around the central barrier.')
    world: str = setting('', 'MJCF file of the world; empty: the playpen.')
    start_x: float = setting(0.0, 'Start in the frame world, m.', -1000.0, 1000.0)
    start_y: float = setting(0.0, 'Start in the frame world, m.', -1000.0, 1000.0)
    start_yaw: float = setting(0.0, 'Heading at the start, rad.', -1000.0, 1000.0)
    random_start_m: float = setting(
        0.0, 'An episode begins up to so far ahead of, behind and beside the start.', 0.0, 2.0
    )
    random_start_rad: float = setting(
        0.0, 'And turned to either side by up to so much.', 0.0, math.pi
    )
    floor: str = setting('asphalt', 'How the tyres grip.', choices=FLOORS)
    noise: bool = setting(False, 'Noise of IMU and laser, another one in each episode.')
    frame_skip: int = setting(1, 'Control periods of 20 ms a step.', 1, 50)
    laser_beams: int = setting(90, "Of the robot's 720, evenly over 270 degrees; 0: none.", 0, 720)
    laser_rate_hz: float = setting(10.0, 'Between two scans the last one stays.', 0.1, 50.0)
    path_points: int = setting(10, 'How many places of the path ahead are seen.', 1, 200)
    path_spacing_m: float = setting(0.2, 'From one of them to the next.', 0.02, 5.0)
    lost_m: float = setting(1.0, 'Farther from the path than this ends an episode.', 0.1, 1000.0)
    time_limit_sec: float = setting(
        0.0, "Simulated time of an episode; 0: the limit of the lab's drives.", 0.0, 1e6
    )

    def __post_init__(self) -> None:
        for each in settings_of(type(self)):
            given = getattr(self, each.name)
            given = os.fspath(given) if isinstance(given, os.PathLike) else given
            given = given.item() if isinstance(given, np.generic) else given  # drawn by chance
            object.__setattr__(self, each.name, each.checked(given, _refused))
        if self.laser_beams == 1:
            raise ValueError('laser_beams=1: allowed is 0, none, or from 2 to 720')


def _refused(which: Setting, given: Any) -> ValueError:
    return ValueError(f'{which.name}={given!r}: allowed is {which.allowed}')
