# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the simulation that the page shows is there, and is the one that is shown."""

from enum import auto, Enum
import math

GONE_SEC = 1.5
"""A simulator that was silent for so long is gone; it speaks 30 times a second, paused or not."""

FIRST_SEC = 3.0
"""How much longer the first scene may take: discovery."""


class State(Enum):
    """What may be the matter."""

    HERE = auto()
    GONE = auto()
    ANOTHER_WORLD = auto()
    TWO = auto()


class Presence:
    """
    Listens to whose scenes come in. Times are of a steady wall clock, in seconds.

    :param world: the key of the world that is shown.
    """

    def __init__(self, world: str, *, now_sec: float) -> None:
        self.world = world
        self._run: str | None = None
        self._heard_sec = now_sec + FIRST_SEC
        self._others_sec = -math.inf
        self._other_world_sec = -math.inf

    def hear(self, world: str, run: str, *, now_sec: float) -> bool:
        """Take notice of a scene; returns whether it is to be shown."""
        if world == self.world and (
            run == self._run or self._run is None or now_sec - self._heard_sec > GONE_SEC
        ):
            self._run, self._heard_sec = run, now_sec
            return True
        if world == self.world:
            self._others_sec = now_sec
        else:
            self._other_world_sec = now_sec
        return False

    def state(self, *, now_sec: float) -> State:
        """Return what is the matter now."""
        here = now_sec - self._heard_sec <= GONE_SEC and self._run is not None
        another = now_sec - self._other_world_sec <= GONE_SEC
        if here:
            two = another or now_sec - self._others_sec <= GONE_SEC
            # One that was just ended is not there together with the next.
            return State.TWO if two and now_sec - self._heard_sec < GONE_SEC / 3 else State.HERE
        if another:
            return State.ANOTHER_WORLD
        return State.GONE if now_sec - self._heard_sec > GONE_SEC else State.HERE
