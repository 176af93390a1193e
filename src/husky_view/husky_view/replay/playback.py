# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where a replay is in time."""


class Playback:
    """Time that plays, stands, jumps and stops at the end."""

    def __init__(self, duration_sec: float) -> None:
        self.duration_sec = duration_sec
        self.time_sec = 0.0
        self.playing = True
        self.factor = 1.0
        self.jumped = True  # since the last step: the past has to be drawn anew

    @property
    def at_end(self) -> bool:
        """Tell whether there is nothing left to play."""
        return self.time_sec >= self.duration_sec

    def jump(self, time_sec: float) -> None:
        """Go to a time of the run; beyond its ends means to them."""
        self.time_sec = min(max(time_sec, 0.0), self.duration_sec)
        self.jumped = True

    def toggle(self) -> None:
        """Play or stand; at the end, play from the start."""
        self.playing = not self.playing or self.at_end
        if self.playing and self.at_end:
            self.jump(0.0)

    def step(self, wall_sec: float) -> bool:
        """
        Let so much wall time pass.

        :returns: whether a jump lies before it.
        """
        jumped, self.jumped = self.jumped, False
        if self.playing and not jumped:
            self.time_sec = min(self.time_sec + wall_sec * self.factor, self.duration_sec)
        if self.at_end:
            self.playing = False
        return jumped
