# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The slip of a skid-steer robot in bends, which wheel odometry does not measure.

A Husky that turns slides outwards, and moves a little further than its wheels roll. Both grow
with speed times yaw rate; the factors depend on tyres and ground, and are measured (Mandow,
Martinez, Morales, Blanco, Garcia-Cerezo, Gonzalez: "Experimental kinematics for wheeled
skid-steer mobile robots", IROS 2007).
"""

from dataclasses import dataclass
import math

from husky_driver.motion import Odometry

MAX_PERIOD_SEC = 0.1


@dataclass(frozen=True)
class SlipModel:
    """
    Velocities that odometry misses, in seconds: times speed times yaw rate they are m/s.

    The defaults are fitted to the true paths of the simulated Husky on the lab's courses.
    """

    outward_sec: float = 0.035
    onward_sec: float = 0.030


NO_SLIP = SlipModel(0.0, 0.0)


class SlipCorrection:
    """Integrates the slip; give it every odometry once, in order."""

    def __init__(self, model: SlipModel) -> None:
        self._model = model
        self.restart()

    def restart(self) -> None:
        self._x = self._y = 0.0
        self._before: Odometry | None = None

    def corrected(self, odometry: Odometry) -> Odometry:
        before, self._before = self._before, odometry
        if before is None:
            return odometry
        period = min(max(odometry.time_sec - before.time_sec, 0.0), MAX_PERIOD_SEC)
        speed = (odometry.speed_m_s + before.speed_m_s) / 2
        rate = (odometry.yaw_rate_rad_s + before.yaw_rate_rad_s) / 2
        left = -self._model.outward_sec * abs(speed) * rate * period
        ahead = self._model.onward_sec * speed * abs(rate) * period
        yaw = odometry.yaw_rad - rate * period / 2
        self._x += math.cos(yaw) * ahead - math.sin(yaw) * left
        self._y += math.sin(yaw) * ahead + math.cos(yaw) * left
        return odometry._replace(x_m=odometry.x_m + self._x, y_m=odometry.y_m + self._y)
