# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a policy sees of an episode, and the spaces of that and of what it answers."""

import cmath
from typing import Any

from gymnasium import spaces
from husky_course.route import Route
from husky_sim.sensors import RANGE_MAX_M
import numpy as np
import numpy.typing as npt

from husky_gym.progress import Progress
from husky_gym.settings import EnvironmentSettings
from husky_sim.config import DriveConfig

Floats = npt.NDArray[np.float32]
Observation = dict[str, Floats]
Estimate = tuple[float, float, float, float, float]
"""x, y, yaw, speed and yaw rate as odometry has them, in the frame of the course."""

GREATEST = (DriveConfig().speed_limit_m_s, DriveConfig().yaw_rate_limit_rad_s)
"""What the velocity controller allows: m/s and rad/s."""
MOST = np.array([1000.0, 1000.0, 3.1416, 3.0, 6.0])
"""Of the odometry: m, m, rad, m/s, rad/s."""
PATH_M = 10.0
LEFT_M = 3000.0


def action_space() -> spaces.Box:
    """Return the space of the actions: parts of GREATEST."""
    return spaces.Box(-1.0, 1.0, (2,), dtype=np.float32)


def observation_space(settings: EnvironmentSettings) -> spaces.Dict:
    """Return the space of the observations; what is outside of it is seen at its border."""
    found: dict[str, spaces.Space[Any]] = {
        'odometry': _box(-MOST, MOST),
        'path': _box(-PATH_M, PATH_M, settings.path_points, 2),
        'asked_speed': _box(-1.0, 1.0, 1),
        'path_left': _box(0.0, LEFT_M, 1),
    }
    if settings.laser_beams:
        found['laser'] = _box(0.0, RANGE_MAX_M, settings.laser_beams)
    return spaces.Dict(found)


def _box(low: Any, high: Any, *shape: int) -> spaces.Box:
    borders = (np.array(border, dtype=np.float32) for border in (low, high))
    low, high = (np.broadcast_to(border, shape) if shape else border for border in borders)
    return spaces.Box(low, high, dtype=np.float32)


class Sight:
    """Sees the path ahead from where the robot believes to be."""

    def __init__(self, route: Route, settings: EnvironmentSettings) -> None:
        self.place = Progress(route)
        curve = route.curve
        self._s, self._path = np.array(curve.s), np.array(curve.x) + 1j * np.array(curve.y)
        self._ahead_m = settings.path_spacing_m * np.arange(1, settings.path_points + 1)
        # All but the laser in one array, which takes half the time: the path first.
        self._path_end = path_end = 2 * settings.path_points
        self._most = np.array([*[PATH_M] * path_end, *MOST, GREATEST[0], LEFT_M])
        self._least = -self._most
        self._numbers = np.empty_like(self._most)
        self._path_numbers = self._numbers[:path_end].view(np.complex128)

    def observe(self, estimate: Estimate, ranges: Floats | None) -> Observation:
        """
        Return an observation.

        :param ranges: those of the last scan; None where there is no laser.
        """
        x, y, yaw = estimate[:3]
        place, numbers, end = self.place, self._numbers, self._path_end
        place.follow(x, y)
        # Complex numbers: to interpolate, to shift and to turn x and y is one call each.
        path = np.interp(place.along_m + self._ahead_m, self._s, self._path)
        turn = cmath.exp(complex(0.0, -yaw))
        np.multiply(path - complex(x, y), turn, out=self._path_numbers)
        numbers[end:] = (*estimate, place.asked_speed_m_s, place.left_m)
        # `np.clip` takes three times as long.
        np.maximum(numbers, self._least, out=numbers)
        np.minimum(numbers, self._most, out=numbers)
        seen = numbers.astype(np.float32)
        found = {
            'odometry': seen[end:-2],
            'path': seen[:end].reshape(-1, 2),
            'asked_speed': seen[-2:-1],
            'path_left': seen[-1:],
        }
        return found if ranges is None else {**found, 'laser': ranges.copy()}
