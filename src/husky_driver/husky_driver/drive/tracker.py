# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow a curve: a pose on it gives a speed and a yaw rate.

Steering: the curve's own yaw rate as feed-forward plus linear feedback of offset and heading error
in the frame of the nearest point (Samson, "Time-varying feedback stabilization of car-like
wheeled mobile robots", IJRR 12(1), 1993; De Luca, Oriolo, Samson, "Feedback control of a
nonholonomic car-like robot", 1998). Unlike pure pursuit it does not cut corners. The speeds are
those planned for the curve.
"""

import math

from husky_course.route import DriveLimits, Leg, LIMITS, plan_speeds

_TWO_PI = 2 * math.pi


# Feedback in the frame of the path; lengths instead of times, so that speed cancels.
OFFSET_PER_M2 = 9.0  # natural frequency squared, 3 per metre
HEADING_PER_M = 6.0  # twice the natural frequency: no overshoot
MAX_OFFSET_M = 0.3  # a greater offset steers no harder
MAX_INWARD_RAD = 0.3
DELAY_SEC = 0.05  # from odometry to the wheels turning at the new speed
PREVIEW_SEC = 0.1  # the curve's yaw rate is commanded this much ahead
END_RATE_PER_S = 8.0  # speed over distance left, close to the end


class Tracker:
    """Follows the curve of one leg; driven backwards, the robot faces against it."""

    def __init__(self, leg: Leg, limits: DriveLimits = LIMITS) -> None:
        self.curve = leg.curve
        self.reverse = leg.reverse
        self.s = 0.0
        self.offset_m = 0.0
        self.heading_error_rad = 0.0
        self._speeds = plan_speeds(leg.curve, leg.speeds_m_s, limits)
        self._most_rad_s = limits.yaw_rate_rad_s
        self._sample = 0

    @property
    def remaining_m(self) -> float:
        return self.curve.length_m - self.s

    def locate(self, x: float, y: float, yaw: float) -> None:
        """Find the place on the curve, the offset and the heading error of a pose."""
        self._sample, self.s, self.offset_m = self.curve.project(self._sample, x, y)
        heading = self.curve.heading_at(self.s) + (math.pi if self.reverse else 0.0)
        self.heading_error_rad = math.remainder(yaw - heading, _TWO_PI)

    def command(
        self,
        x: float,
        y: float,
        yaw: float,
        speed_m_s: float,
        yaw_rate_rad_s: float,
        *,
        outward_sec2: float = 0.0,
    ) -> tuple[float, float]:
        """
        Return the speed (negative backwards) and yaw rate for the robot's pose and twist.

        :param outward_sec2: how it slides in bends, see `drive.slip.Slip`.
        """
        middle = yaw + yaw_rate_rad_s * DELAY_SEC / 2
        self.locate(
            x + speed_m_s * DELAY_SEC * math.cos(middle),
            y + speed_m_s * DELAY_SEC * math.sin(middle),
            yaw + yaw_rate_rad_s * DELAY_SEC,
        )
        speed = self._speed()
        bend = self._bend(speed)
        error = self.heading_error_rad - _inward_rad(speed * bend, outward_sec2)
        offset = min(max(self.offset_m, -MAX_OFFSET_M), MAX_OFFSET_M)
        ahead = math.cos(error) / max(1.0 - bend * self.offset_m, 0.3)
        sinc = math.sin(error) / error if abs(error) > 1e-6 else 1.0
        feedback = OFFSET_PER_M2 * offset * sinc + HEADING_PER_M * error
        limit = self._most_rad_s
        yaw_rate = min(max(speed * (bend * ahead - feedback), -limit), limit)
        speed *= max(math.cos(error), 0.0)
        return (-speed if self.reverse else speed), yaw_rate

    def _speed(self) -> float:
        """Return the planned speed; near the end it falls with the distance left."""
        speeds, curve = self._speeds, self.curve
        i = self._sample
        part = (self.s - curve.s[i]) / (curve.s[i + 1] - curve.s[i])
        here, there = speeds[i], speeds[i + 1]
        planned = math.sqrt(max(here * here + part * (there * there - here * here), 0.0))
        remaining = curve.length_m - self.s
        return min(planned, max(END_RATE_PER_S * remaining, 0.02))

    def _bend(self, speed: float) -> float:
        """Return the mean curvature of the stretch that this command will drive."""
        preview = max(speed * PREVIEW_SEC, 0.02)
        start = self.s + preview * 0.5
        end = min(start + preview, self.curve.length_m)
        start = min(start, end - 0.01)
        return (self.curve.heading_at(end) - self.curve.heading_at(start)) / (end - start)


def _inward_rad(yaw_rate_rad_s: float, outward_sec2: float) -> float:
    """
    Return how far to the left of a bend a robot must face, that slides outwards.

    That of the planned motion: the measured one would drive itself on.
    """
    inward = outward_sec2 * yaw_rate_rad_s * abs(yaw_rate_rad_s)
    return min(max(inward, -MAX_INWARD_RAD), MAX_INWARD_RAD)
