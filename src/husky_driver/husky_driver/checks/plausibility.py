# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Check messages for values that cannot be true, before they are used.

Each function returns in a few words what is wrong, or an empty string.
"""

from collections.abc import Mapping
import math
from typing import Any

from husky_driver.motion import Odometry

FARTHEST_M = 1e6
FASTEST_M_S = 10.0  # a Husky drives 1 m/s; wheels in the air turn faster
FASTEST_RAD_S = 20.0
LENGTH_ERROR = 0.1  # of a quaternion
JUMP_M, JUMP_M_S = 0.25, 2.0  # a jump: more than the first, plus the second times the period
JUMP_RAD, JUMP_RAD_S = 0.5, 4.0
STEP_SEC = 0.1  # odometry comes more often than this
AHEAD_SEC = 30.0  # no longer gap in odometry is accepted
RESET_SEC = 1.0  # after a reset of the simulator the stamp is at most this, ...
RESET_M_S = 0.3  # ... and the robot drives at most this fast
HARDEST_M_S2 = 1e5  # no impact is harder


class OdometryCheck:
    """Checks every odometry message of one robot, in the order of arrival."""

    def __init__(self) -> None:
        self._last: Odometry | None = None
        self._before_reset_sec = math.inf
        self._reset_sec = 0.0

    def complaint(self, now: Odometry) -> str:
        """Return why the next message cannot be true; after one that cannot, the check is over."""
        if what := _out_of_range(now):
            return what
        last, self._last = self._last, now
        if last is None:
            return ''
        if now.time_sec < last.time_sec:
            return self._going_back(last, now)
        if self._returns(last, now):
            return (
                f'its stamp jumps to and fro between {last.time_sec:.2f} s and '
                f'{now.time_sec:.2f} s'
            )
        if now.time_sec - last.time_sec > AHEAD_SEC:
            return f'its stamp jumps ahead from {last.time_sec:.2f} s to {now.time_sec:.2f} s'
        return _jump(last, now)

    def _going_back(self, last: Odometry, now: Odometry) -> str:
        slow = abs(now.speed_m_s) < RESET_M_S and abs(now.yaw_rate_rad_s) < RESET_M_S
        if not slow or not 0.0 <= now.time_sec <= RESET_SEC:
            return (
                f'its stamp goes back from {last.time_sec:.2f} s to {now.time_sec:.2f} s, '
                'which is no reset'
            )
        self._before_reset_sec, self._reset_sec = last.time_sec, now.time_sec
        return ''

    def _returns(self, last: Odometry, now: Odometry) -> bool:
        """Return whether the time from before a reset goes on: then there are two publishers."""
        halfway_sec = (self._before_reset_sec - self._reset_sec) / 2
        if now.time_sec - last.time_sec < max(halfway_sec, STEP_SEC):
            if now.time_sec > self._reset_sec + RESET_SEC:
                self._before_reset_sec = math.inf
            return False
        return now.time_sec >= self._before_reset_sec


def _out_of_range(now: Odometry) -> str:
    for name, value, unit, most in (
        ('stamp', now.time_sec, 's', math.inf),
        ('x', now.x_m, 'm', FARTHEST_M),
        ('y', now.y_m, 'm', FARTHEST_M),
        ('yaw', now.yaw_rad, 'rad', math.inf),
        ('speed', now.speed_m_s, 'm/s', FASTEST_M_S),
        ('yaw rate', now.yaw_rate_rad_s, 'rad/s', FASTEST_RAD_S),
    ):
        if not math.isfinite(value) or abs(value) > most:
            return f'its {name} is {value:.6g} {unit}'
    return ''


def _jump(last: Odometry, now: Odometry) -> str:
    period_sec = now.time_sec - last.time_sec
    away_m = math.hypot(now.x_m - last.x_m, now.y_m - last.y_m)
    if away_m > JUMP_M + JUMP_M_S * period_sec:
        return (
            f'it jumps {away_m:.2f} m in {period_sec:.2f} s, from '
            f'({last.x_m:.2f}, {last.y_m:.2f}) to ({now.x_m:.2f}, {now.y_m:.2f})'
        )
    turned = math.remainder(now.yaw_rad - last.yaw_rad, 2 * math.pi)
    if abs(turned) > JUMP_RAD + JUMP_RAD_S * period_sec:
        return f'it jumps by {turned:.2f} rad of yaw in {period_sec:.2f} s'
    return ''


def no_rotation(q: Any) -> str:
    """Return why a quaternion (with x, y, z, w) is no rotation."""
    length = math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w)
    if abs(length - 1.0) <= LENGTH_ERROR:  # NaN is not
        return ''
    parts = ', '.join(f'{value:.6g}' for value in (q.x, q.y, q.z, q.w))
    return f'its orientation ({parts}) is no rotation: its length is {length:.6g}, not 1'


def no_numbers(values: Mapping[str, float], most: float = HARDEST_M_S2) -> str:
    """Return which of the values is not finite, or greater than allowed."""
    for name, value in values.items():
        if not math.isfinite(value) or abs(value) > most:
            return f'its {name} is {value:.6g}'
    return ''
