# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Stop while the laser shows an obstacle on the path, or while no scan comes."""

import math

import numpy as np

from husky_driver.checks.path_scan import LASER_X_M, look_along, Scan, Sighting
from husky_driver.drive.drive import Drive

SCAN_TIMEOUT_SEC = 1.0  # an older scan says nothing about the path
GIVE_UP_SEC = 60.0  # how long the robot waits for a free path
SPEED_MARGIN_M_S = 0.1


class ObstacleStop:
    """
    Decides when the robot has to stand; times are the stamps of scans and odometry.

    :param topic: of the scans, to be named.
    :param laser_x_m: how far ahead of base_link the laser stands.
    """

    def __init__(self, topic: str = 'front/scan', laser_x_m: float = LASER_X_M) -> None:
        self._topic, self._laser_x_m = topic, laser_x_m
        self._restart(-math.inf)

    def _restart(self, now_sec: float) -> None:
        self.holds = True  # also before the first scan
        self._sighting: Sighting | None = None
        self._blind = False  # whether the last scan has measured nothing
        self._scanned_sec = -math.inf
        self._begun_sec = self._free_sec = self._now_sec = now_sec
        self._state = 'free'

    def add_scan(self, scan: Scan, drive: Drive) -> None:
        """Search the path ahead, unless the robot drives backwards or has not begun."""
        now, tracker = drive.odometry, drive.tracker
        if now is not None and scan.time_sec > now.time_sec + SCAN_TIMEOUT_SEC:
            return  # from before a reset: its stamp would hide that scans are missing
        self._blind = bool(np.isnan(scan.ranges).all())  # also without a single range
        if self._blind:
            return
        self._scanned_sec = scan.time_sec
        self._sighting = None
        if now is not None and tracker is not None and not tracker.reverse:
            # A standing robot uses the speed it would drive at; else it would creep on.
            start_m_s = drive.course.speed_m_s + SPEED_MARGIN_M_S if self.holds else 0.0
            speed_m_s = max(drive.speed_m_s, start_m_s)
            pose = (now.x_m, now.y_m, now.yaw_rad)
            self._sighting = look_along(
                *(scan, pose, tracker.curve, tracker.s, speed_m_s),
                braking_m_s2=drive.limits.stopping_m_s2,
                laser_x_m=self._laser_x_m,
            )

    def update(self, now_sec: float) -> str:
        """Decide again, for each odometry; return a line for the log when the state changes."""
        if math.isinf(self._begun_sec) or now_sec < self._now_sec:  # first odometry, or a reset
            self._restart(now_sec)
        self._now_sec = now_sec
        silent = now_sec - max(self._scanned_sec, self._begun_sec) > SCAN_TIMEOUT_SEC
        state = 'silent' if silent else 'seen' if self._sighting else 'free'
        self.holds = state != 'free' or math.isinf(self._scanned_sec)
        if not self.holds:
            self._free_sec = now_sec
        changed, self._state = state != self._state, state
        return self._describe() if changed else ''

    @property
    def complaint(self) -> str:
        """Why the drive must end, after GIVE_UP_SEC without a free path; else empty."""
        if self._now_sec - self._free_sec < GIVE_UP_SEC:
            return ''
        return f'stood for {GIVE_UP_SEC:g} s: {self._describe()}'

    def _describe(self) -> str:
        if self._state == 'silent' and self._blind:
            return f'standing: the scans on {self._topic} measure nothing: no range is a number'
        if self._state == 'silent':
            return f'standing: no scan comes on {self._topic}; is the laser on (lidar_rate_hz)?'
        return f'stopping: {self._sighting}' if self._sighting else 'the way is free: driving on'
