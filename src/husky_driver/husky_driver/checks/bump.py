# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Detect from wheel speeds and the accelerometer that something holds the robot.

The wheels of a robot that pushes straight against a wall go on turning, so its odometry goes on,
the filtered one too. But the IMU has measured the impact: the robot lost a speed that the wheels
have not lost (Ward, Iagnemma: "A dynamic-model-based wheel slip detector for mobile robots
on outdoor terrain", IEEE Transactions on Robotics 24, 2008, compare the same two). Slower than
0.15 m/s a jolt is too weak to tell from noise.
"""

from collections import deque
import math
from typing import NamedTuple

LAG_SEC = 0.1  # samples are used at this age, so that late delivery does not change a run
WINDOW_SEC = 2.0
GAP_SEC = 0.03  # a longer gap between samples means that one was lost: begin again
WHEELS_GAP_SEC = 0.2  # after one between odometries nobody knows how the wheels turned in it
LOST_SHARE = 0.6  # of the wheels' speed
LOST_M_S = 0.08  # less may come from noise and bends
PIVOT_M = 0.2  # and so much for each rad/s, from where the point lies about which it turns
SLOWEST_M_S = 0.1  # below it, noise would be most of the lost speed
HELD_SEC = 0.5  # a robot that slides along an edge gets its speed back sooner


class _Sample(NamedTuple):
    time_sec: float
    speed_m_s: float  # of the wheels
    yaw_rate_rad_s: float
    gained_nm_s: int  # by the IMU; sums of whole numbers do not depend on where they begin


class Bump:
    """Compares wheels and IMU; give it both in order of time."""

    def __init__(self) -> None:
        self._accelerations: deque[tuple[float, float]] = deque(maxlen=1000)
        self._wheels: deque[tuple[float, float, float]] = deque(maxlen=1000)
        self._window: deque[_Sample] = deque()
        self._free_sec = 0.0

    def add_acceleration(self, time_sec: float, acceleration_m_s2: float) -> None:
        """Add a sample of the IMU."""
        if math.isfinite(time_sec) and math.isfinite(acceleration_m_s2):
            self._accelerations.append((time_sec, acceleration_m_s2))

    def is_held(self, time_sec: float, speed_m_s: float, yaw_rate_rad_s: float = 0.0) -> bool:
        """Add the speed of the wheels; return whether the robot moves more slowly than they do."""
        if self._wheels and time_sec - self._wheels[-1][0] > WHEELS_GAP_SEC:
            self._begin_again(time_sec)
        self._wheels.append((time_sec, speed_m_s, yaw_rate_rad_s))
        samples, begin_sec, end_sec = (
            self._accelerations,
            time_sec - LAG_SEC,
            time_sec + WINDOW_SEC,
        )
        while samples and (samples[0][0] <= begin_sec or samples[0][0] > end_sec):
            self._integrate(*samples.popleft())
        if not self._window:
            return False
        now = self._window[-1]
        speed, lost_m_s = abs(now.speed_m_s), self._lost_m_s()
        if (
            speed < SLOWEST_M_S
            or lost_m_s < max(LOST_SHARE * speed, LOST_M_S)
            or lost_m_s < LOST_M_S + PIVOT_M * self._fastest_turn_rad_s()
        ):
            self._free_sec = now.time_sec
        return now.time_sec - self._free_sec > HELD_SEC

    def _begin_again(self, time_sec: float) -> None:
        self._window.clear()
        self._wheels.clear()
        while self._accelerations and self._accelerations[0][0] <= time_sec:
            self._accelerations.popleft()

    def _integrate(self, time_sec: float, acceleration_m_s2: float) -> None:
        window, wheels = self._window, self._wheels
        while len(wheels) > 1 and wheels[1][0] <= time_sec:
            wheels.popleft()
        before = window[-1].time_sec if window else time_sec
        if not before <= time_sec <= before + GAP_SEC:
            window.clear()
        if not window:
            self._free_sec = before = time_sec
        elif time_sec == before:
            return  # a simulator in lockstep repeats its first message
        gained = round(1e9 * acceleration_m_s2 * (time_sec - before))
        gained += window[-1].gained_nm_s if window else 0
        window.append(_Sample(time_sec, *wheels[0][1:], gained))
        while window[0].time_sec < time_sec - WINDOW_SEC:
            window.popleft()

    def _fastest_turn_rad_s(self) -> float:
        """Return the yaw rate by which the loss is unsure: a turn counts to both its ends."""
        return max(abs(each.yaw_rate_rad_s) for each in self._window)

    def _lost_m_s(self) -> float:
        """Return how much speed the robot has lost that its wheels have not."""
        first, last = self._window[0], self._window[-1]
        gained = (last.gained_nm_s - first.gained_nm_s) / 1e9
        lost = last.speed_m_s - first.speed_m_s - gained
        return lost if last.speed_m_s > 0.0 else -lost
