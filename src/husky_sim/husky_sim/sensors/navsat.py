# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The satellite navigation receiver: where the robot is on the Earth.

The origin of `world` lies at the reference of the original (49.9 N, 8.9 E, altitude 0), with x to
the east and y to the north.
"""

import math
from typing import NamedTuple

from husky_sim.robot.husky import Vector
from husky_sim.sensors.noise import Noise

LATITUDE_DEG, LONGITUDE_DEG, ALTITUDE_M = 49.9, 8.9, 0.0
DRIFT_M = 0.0001
VARIANCE_M2 = DRIFT_M * DRIFT_M

# WGS 84
_EQUATOR_M = 6378137.0
_FLATTENING = 1.0 / 298.257223563


class Fix(NamedTuple):
    """A place on the Earth."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float


class NavSat:
    """Locates one robot."""

    def __init__(self, noise: Noise | None) -> None:
        self._noise = noise
        # Radii of curvature, of the meridian and of the parallel circle.
        squared = _FLATTENING * (2.0 - _FLATTENING)
        latitude_rad = math.radians(LATITUDE_DEG)
        across = _EQUATOR_M / math.sqrt(1.0 - squared * math.sin(latitude_rad) ** 2)
        self._north_m = across**3 * (1.0 - squared) / _EQUATOR_M**2
        self._east_m = across * math.cos(latitude_rad)

    def locate(self, position: Vector, period_sec: float) -> Fix:
        """Return the fix of a place in `world`."""
        x, y, z = position
        if self._noise is not None:
            dx, dy, dz = self._noise.sample(period_sec).tolist()
            x, y, z = x + dx, y + dy, z + dz
        return Fix(
            LATITUDE_DEG + math.degrees(y / self._north_m),
            LONGITUDE_DEG + math.degrees(x / self._east_m),
            ALTITUDE_M + z,
        )


def new_noise(seed: list[int]) -> Noise:
    """Make the noise of a receiver, which is drift alone."""
    return Noise(3, deviation=0.0, drift=DRIFT_M, seed=seed)
