# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The slip of a skid-steer robot, which wheel odometry does not measure.

A Husky in a bend slides outwards and moves a little further than its wheels roll. Where one side
bears more weight, it turns about a point beside its middle and creeps to that side. How much
depends on tyres and ground (Mandow, Martinez, Morales, Blanco, Garcia-Cerezo, Gonzalez:
"Experimental kinematics for wheeled skid-steer mobile robots", IROS 2007), so
`drive.motion_estimate` learns it on the way.
"""

from typing import NamedTuple

from husky_course.route import DriveLimits, LIMITS

from husky_driver.motion import Command, Odometry


class Slip(NamedTuple):
    """
    What the wheels do not tell; the defaults are those of the simulated Husky on asphalt.

    With u the speed of the wheels and w the yaw rate, the robot moves forwards with
    v = u + pivot_m * w + onward_sec * u * abs(w), and to the left with
    -outward_sec2 * v * w * abs(w) - aside_m_s * w * w.
    """

    pivot_m: float = 0.0  # the robot turns on the spot about a point so far to its right
    onward_sec: float = 0.025
    outward_sec2: float = 0.1
    aside_m_s: float = 0.0  # to the side that bears more weight, whichever way it turns
    yaw_gain: float = 1.0  # yaw rate over that commanded

    @property
    def ground(self) -> tuple[float, float, float, float]:
        """All but the gain."""
        return self.pivot_m, self.onward_sec, self.outward_sec2, self.aside_m_s

    def velocity(self, odometry: Odometry) -> tuple[float, float]:
        """Return the speeds forwards and to the left, m/s, of a robot in steady motion."""
        wheels, rate = odometry.speed_m_s, odometry.yaw_rate_rad_s
        ahead = wheels + self.pivot_m * rate + self.onward_sec * wheels * abs(rate)
        left = -self.outward_sec2 * ahead * rate * abs(rate) - self.aside_m_s * rate * rate
        return ahead, left

    def command(self, wish: Command, limits: DriveLimits = LIMITS) -> Command:
        """Return what to command, so that the robot moves as wished."""
        speed, rate = wish
        wheels = (speed - self.pivot_m * rate) / (1.0 + self.onward_sec * abs(rate))
        limit, turn = limits.speed_m_s, limits.yaw_rate_rad_s
        return Command(
            min(max(wheels, -limit), limit), min(max(rate / self.yaw_gain, -turn), turn)
        )
