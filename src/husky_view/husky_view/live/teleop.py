# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Driving by hand: buttons that are held become velocity commands.

A page reports at HOLD_HZ that a button is held, and once that it was released. When its reports
end, because the tab, the browser or the network is gone, the robot is stopped as well.
"""

from husky_view.picture.page import Direction

HOLD_HZ = 15.0
HOLD_TIMEOUT_SEC = 0.7
"""How long a report counts: a page that draws slowly may miss several."""

STOPS = 5
"""Zero velocities sent at the end, in case that one gets lost."""


class Teleop:
    """The buttons that are held in all tabs. Times are of a steady wall clock."""

    def __init__(self, *, speed_m_s: float = 0.5, yaw_rate_rad_s: float = 0.8) -> None:
        self.speed_m_s = speed_m_s
        self.yaw_rate_rad_s = yaw_rate_rad_s
        self._held_sec: dict[tuple[int, Direction], float] = {}
        self._stops = 0

    def hold(self, tab: int, direction: Direction, *, now_sec: float) -> None:
        """Register that a button is held in a tab."""
        self._held_sec[tab, direction] = now_sec

    def release(self, tab: int, direction: Direction) -> None:
        """Register that a button was released."""
        self._held_sec.pop((tab, direction), None)

    def release_tab(self, tab: int) -> None:
        """Release what is held in a tab, which is gone."""
        for direction in Direction:
            self.release(tab, direction)

    def release_all(self) -> None:
        """Release all buttons."""
        self._held_sec.clear()

    def command(self, *, now_sec: float) -> tuple[float, float] | None:
        """Return the speed and the yaw rate to send now; None while nobody drives."""
        held = {
            direction
            for (_, direction), at_sec in self._held_sec.copy().items()
            if now_sec - at_sec <= HOLD_TIMEOUT_SEC
        }
        if held:
            self._stops = STOPS
            forward = sum(direction.forward for direction in held)
            left = sum(direction.left for direction in held)
            return forward * self.speed_m_s, left * self.yaw_rate_rad_s
        if self._stops == 0:
            return None
        self._stops -= 1
        return 0.0, 0.0
