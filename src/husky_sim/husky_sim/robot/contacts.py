# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Touches between robots and obstacles.

A touch begins when a part of a robot meets an obstacle or another robot, and ends when the two
have been apart for RELEASE_SEC. It is reported once, PEAK_SEC after it began, with the greatest
force until then. Wheels on the ground touch nothing.
"""

from dataclasses import dataclass, replace
import math

from husky_course.record import Collision as Collision
import mujoco
import numpy as np

from husky_sim.world.world import World

PEAK_SEC = 0.1
RELEASE_SEC = 0.5
_REMEMBERED = 10000


@dataclass
class _Contact:
    touch: Collision
    last_seen_sec: float
    force_n: float = 0.0
    reported: bool = False

    def report(self) -> Collision:
        self.reported = True
        return replace(self.touch, force_n=self.force_n)


class TouchDetector:
    """Detects touches in the contacts of every physics step."""

    def __init__(self, world: World, data: mujoco.MjData) -> None:
        self._world = world
        self._data = data
        self._robots = len(world.robots)
        self._harmless: set[bytes] = set()
        self._contacts: dict[tuple[int, int], _Contact] = {}
        self._force = np.zeros(6)

    def reset(self) -> None:
        """Forget every touch."""
        self._contacts.clear()

    def update(self, time_sec: float) -> bool:
        """Read the contacts after a physics step; return whether a robot touches something."""
        # Nearly always the pairs are those of an earlier step: wheels and ground.
        pairs = self._data.contact.geom.tobytes()
        if self._world.flex_owners.size:
            pairs += self._data.contact.flex.tobytes()
        if pairs in self._harmless:
            return False
        owners = self._world.touching(self._data)
        touches = np.flatnonzero((owners >= 0).all(axis=1) & (owners[:, 0] != owners[:, 1]))
        if not touches.size:
            if len(self._harmless) < _REMEMBERED:
                self._harmless.add(pairs)
            return False
        now: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for index in touches.tolist():
            (one, other), geoms = owners[index].tolist(), self._data.contact.geom[index].tolist()
            for ours, theirs, geom in ((one, other, geoms[0]), (other, one, geoms[1])):
                if ours < self._robots:
                    now.setdefault((ours, theirs), []).append((index, geom))
        for pair, contacts in now.items():
            self._see(pair, contacts, time_sec)
        return True

    def _see(
        self, pair: tuple[int, int], contacts: list[tuple[int, int]], time_sec: float
    ) -> None:
        known = self._contacts.get(pair)
        if known is None or time_sec - known.last_seen_sec > RELEASE_SEC:
            known = _Contact(self._begin(pair, contacts, time_sec), time_sec)
            self._contacts[pair] = known
        known.last_seen_sec = time_sec
        known.force_n = max(known.force_n, math.fsum(self._normal_force(i) for i, _ in contacts))

    def _begin(
        self, pair: tuple[int, int], contacts: list[tuple[int, int]], time_sec: float
    ) -> Collision:
        depths = self._data.contact.dist
        index, geom = min(contacts, key=lambda contact: float(depths[contact[0]]))
        x, y, z = self._data.contact.pos[index].tolist()
        names = self._world.names
        return Collision(
            robot=names[pair[0]],
            obstacle=names[pair[1]],
            part=self._world.part(geom),
            time_sec=time_sec,
            force_n=0.0,
            position=(x, y, z),
        )

    def _normal_force(self, index: int) -> float:
        mujoco.mj_contactForce(self._world.model, self._data, index, self._force)
        return abs(float(self._force[0]))

    def reports(self, time_sec: float) -> list[Collision]:
        """Return the touches that began PEAK_SEC ago and were not reported yet; at inf, all."""
        return [
            contact.report()
            for contact in self._contacts.values()
            if not contact.reported and time_sec - contact.touch.time_sec >= PEAK_SEC
        ]
