# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Which odometry has to wait for the IMU.

What is learned from the IMU changes the commands. So that the same run gives the same commands,
however late a reading is delivered, an odometry is answered when the readings have come that count
for it. Where a robot has no IMU, or has lost a reading, nobody waits for long. Time is counted in
ticks of the node's timer, which stands still when the computer does.
"""

from husky_driver.drive.motion_estimate import LAG_SEC, SAME_SEC

NOBODY_SEC = 0.5  # wall time at the start, where nobody publishes readings
START_SEC = 3.0  # the same where somebody does
LOST_SEC = 0.2  # later: then a reading is lost


class ImuWait:
    """
    Says for each odometry whether to wait; times are those of stamps, in seconds.

    :param tick_sec: wall time between two calls of `tick`.
    """

    def __init__(self, tick_sec: float) -> None:
        self._tick_sec = tick_sec
        self._newest_sec: float | None = None
        self._given_up = False
        self._ticks: int | None = None  # since it waits; None: it does not

    def tick(self) -> None:
        """Take note of the passing of time."""
        if self._ticks is not None:
            self._ticks += 1

    def saw(self, time_sec: float) -> None:
        """Take note of a reading; after a reset its time may lie before the last."""
        self._newest_sec = time_sec
        self._given_up = False

    def has_to_wait(self, time_sec: float, *, first: bool, publishers: int) -> bool:
        """
        Return whether readings are missing, and may still come.

        :param first: the drive begins with this odometry.
        :param publishers: how many publish readings.
        """
        counting_sec = time_sec - (0.0 if first else LAG_SEC) - SAME_SEC
        come = self._newest_sec is not None and self._newest_sec >= counting_sec
        if come or self._given_up:
            self._ticks = None
            return False
        self._ticks = 0 if self._ticks is None else self._ticks
        limit_sec = (START_SEC if publishers else NOBODY_SEC) if first else LOST_SEC
        self._given_up = self._ticks * self._tick_sec >= limit_sec
        return not self._given_up

    @property
    def is_missing(self) -> bool:
        """Whether no reading has ever come, and none is waited for any more."""
        return self._given_up and self._newest_sec is None
