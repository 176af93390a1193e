# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How a camera follows a robot: it glides after it and keeps the view that its person chose.

The page tells where its camera is only some time later. So what it tells is compared with what
was asked for: a difference is the person's doing, who then has the camera alone for a moment.
"""

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GLIDE_SEC = 0.15
"""Of a distance from the robot, about two thirds are made up for in this time."""

HANDS_OFF_SEC = 0.3
"""How long the camera stands after a person turned or zoomed it."""

ECHO_SEC = 0.2
"""How long to wait until the page tells of the camera it was given, before it is given the next:
what a person does meanwhile would be overridden unseen."""

JUMP_M = 5.0
"""A robot further away than this did not drive there: it was reset, or a replay jumped."""

_HEARD_SEC = 1.0  # by then a page has told of the camera it was given
_SAME = 0.002  # of the distance
_STILL_M = 0.0005


class Chase:
    """
    The camera of one tab. Times are of a steady wall clock, in seconds.

    :param offset: from the robot to the camera.
    """

    def __init__(self, robot: Array, offset: Array, *, now_sec: float) -> None:
        self.at = robot.copy()
        self.offset = offset
        self._begun_sec = self._before_sec = now_sec
        self._hands_off_until_sec = -math.inf
        self._heard = False
        self._reported: Array | None = None
        self._given_sec = -math.inf
        self._given = offset  # before a person changed it
        self._undone = False

    def report(self, offset: Array) -> None:
        """Take what the page tells of its camera; from any thread."""
        self._reported = offset

    def step(self, robot: Array, *, now_sec: float) -> bool:
        """Go on; returns whether the camera is to be moved, to look at `at` from `offset`."""
        self._listen(now_sec)
        if now_sec - self._given_sec < ECHO_SEC:
            return False
        elapsed_sec, self._before_sec = now_sec - self._before_sec, now_sec
        if now_sec < self._hands_off_until_sec:
            return False
        lag = robot - self.at
        distance_m = float(np.linalg.norm(lag))
        if distance_m < _STILL_M:
            undone, self._undone = self._undone, False
            return undone or not self._heard
        self._undone = False
        self._given_sec = now_sec
        glide = 1.0 - math.exp(-elapsed_sec / GLIDE_SEC)
        self.at = robot.copy() if distance_m > JUMP_M else self.at + glide * lag
        return True

    def _listen(self, now_sec: float) -> None:
        offset, self._reported = self._reported, None
        self._heard = self._heard or now_sec - self._begun_sec > _HEARD_SEC
        if offset is None or not np.any(offset):
            return
        self._given_sec = -math.inf
        if _same(offset, self.offset):
            self._heard = True
            self._given = self.offset
        elif now_sec < self._hands_off_until_sec and _same(offset, self._given):
            # What we sent before we knew has reached the page after the person's doing.
            self._undone = True
        elif self._heard:  # or else it is of before the camera was given to us
            self.offset = offset
            self._hands_off_until_sec = now_sec + HANDS_OFF_SEC


def _same(one: Array, other: Array) -> bool:
    return bool(np.linalg.norm(one - other) <= _SAME * np.linalg.norm(other))
