# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Driving by hand: what is held down becomes a velocity.

The page tells again and again that a key or a button is held, and once that it was released.
When it falls silent, because the tab, the browser or the network is gone, the robot is told to
stop as well.
"""

from enum import Enum

HELD_SEC = 0.7
"""How long a hold counts; a page that draws slowly may miss some of its 1 / HOLD_HZ seconds."""

HOLD_HZ = 15.0
STOPS = 5
"""Zero velocities sent at the end, in case that one gets lost."""


class Direction(Enum):
    """A button of the pad: its sign on the page and what it does (forward, left)."""

    FORWARD = ('▲', 1.0, 0.0)
    LEFT = ('◀', 0.0, 1.0)
    RIGHT = ('▶', 0.0, -1.0)
    BACK = ('▼', -1.0, 0.0)

    @property
    def sign(self) -> str:
        """Return what stands on the button."""
        return self.value[0]


class Pad:
    """Which buttons are held down. Times are of a steady wall clock, in seconds."""

    def __init__(self, *, speed_m_s: float = 0.5, yaw_rate_rad_s: float = 0.8) -> None:
        self.speed_m_s = speed_m_s
        self.yaw_rate_rad_s = yaw_rate_rad_s
        self._held: dict[tuple[int, Direction], float] = {}
        self._stops = 0

    def hold(self, tab: int, direction: Direction, *, now_sec: float) -> None:
        """Take notice that a button is held in a tab."""
        self._held[tab, direction] = now_sec

    def release(self, tab: int, direction: Direction) -> None:
        """Let go of a button."""
        self._held.pop((tab, direction), None)

    def release_tab(self, tab: int) -> None:
        """Let go of what is held in a tab, which is gone."""
        for direction in Direction:
            self.release(tab, direction)

    def release_all(self) -> None:
        """Let go of everything."""
        self._held.clear()

    def command(self, *, now_sec: float) -> tuple[float, float] | None:
        """Return the speed and the yaw rate to send now; None while nobody drives."""
        held = {
            direction
            for (_, direction), at_sec in self._held.copy().items()
            if now_sec - at_sec <= HELD_SEC
        }
        if held:
            self._stops = STOPS
            forward = sum(direction.value[1] for direction in held)
            left = sum(direction.value[2] for direction in held)
            return forward * self.speed_m_s, left * self.yaw_rate_rad_s
        if self._stops == 0:
            return None
        self._stops -= 1
        return 0.0, 0.0
