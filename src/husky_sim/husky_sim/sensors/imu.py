# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The inertial measurement unit: 50 Hz, at base_link, as the original's Gazebo plugin has it.

Noise and drift are those of husky_description for ROS Noetic: 0.005 m/s2, rad/s and rad each.
"""

import math
from typing import NamedTuple

from husky_sim.robot.husky import Husky, into_body, Quaternion, RobotState, Vector
from husky_sim.sensors.noise import Noise

DEVIATION = 0.005
VARIANCE = DEVIATION * DEVIATION


class ImuSample(NamedTuple):
    """
    A measurement: orientation in `world` (w, x, y, z), the rest in base_link.

    Where gravity is inclined, the orientation says so, as one that is felt does.
    """

    orientation: Quaternion
    angular_velocity: Vector
    acceleration: Vector
    yaw: float


class Imu:
    """Measures one robot. The acceleration is the specific force, so it includes gravity."""

    def __init__(self, husky: Husky, noise: Noise | None) -> None:
        self._husky = husky
        self._noise = noise
        x, y, z = husky.gravity
        self._up: Vector | None = (-x, -y, -z) if x or y else None  # where it is inclined
        self.reset()

    def reset(self) -> None:
        """Forget the last sample."""
        self._velocity: Vector = (0.0, 0.0, 0.0)
        if self._noise is not None:
            self._noise.reset()

    def measure(self, state: RobotState, period_sec: float) -> ImuSample:
        """Take the sample at the end of a control period."""
        velocity = self._husky.world_velocity()
        acceleration = self._husky.specific_force(self._velocity, velocity, period_sec)
        self._velocity = velocity
        orientation = state.orientation
        if self._up is not None:
            orientation = _felt(into_body(orientation, self._up), state.yaw)
        sample = ImuSample(orientation, state.angular_velocity, acceleration, state.yaw)
        return sample if self._noise is None else disturbed(sample, self._noise, period_sec)


def new_noise(seed: list[int]) -> Noise:
    """Make the noise of an IMU: three accelerations, three rates, one heading."""
    return Noise(7, deviation=DEVIATION, drift=DEVIATION, seed=seed)


def disturbed(sample: ImuSample, noise: Noise, period_sec: float) -> ImuSample:
    """Return an exact sample with the errors of this noise."""
    errors = noise.sample(period_sec).tolist()
    acceleration, rate = sample.acceleration, sample.angular_velocity
    return ImuSample(
        _turned(sample.orientation, errors[6]),
        (rate[0] + errors[3], rate[1] + errors[4], rate[2] + errors[5]),
        (acceleration[0] + errors[0], acceleration[1] + errors[1], acceleration[2] + errors[2]),
        math.remainder(sample.yaw + errors[6], math.tau),
    )


def _felt(up: Vector, yaw: float) -> Quaternion:
    """Return the orientation with this heading in which a robot has `up` above it."""
    x, y, z = up
    pitch, roll = math.atan2(-x, math.hypot(y, z)), math.atan2(y, z)
    cos, sin = math.cos(pitch / 2.0), math.sin(pitch / 2.0)
    cos_roll, sin_roll = math.cos(roll / 2.0), math.sin(roll / 2.0)
    level = (cos * cos_roll, cos * sin_roll, sin * cos_roll, -sin * sin_roll)
    return _turned(level, yaw)


def _turned(orientation: Quaternion, angle_rad: float) -> Quaternion:
    """Turn an orientation about the vertical."""
    w, x, y, z = orientation
    cos, sin = math.cos(angle_rad / 2.0), math.sin(angle_rad / 2.0)
    return (cos * w - sin * z, cos * x - sin * y, cos * y + sin * x, cos * z + sin * w)
