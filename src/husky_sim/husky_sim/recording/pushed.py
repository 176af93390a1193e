# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The poses of the loose bodies of a world that were pushed during a run.

Loose is every body outside the robots that has a joint. Its pose is recorded only when it has
moved.
"""

from husky_course.frames import Indices
import numpy as np

from husky_sim.simulation import Simulation
from husky_sim.world.world import World

MOVED = 1e-3
"""Of any joint coordinate: a millimetre, or about a tenth of a degree."""

_DIGITS = 4


def loose_bodies(world: World) -> dict[str, slice]:
    """Return which part of qpos belongs to every loose body, by name."""
    model = world.model
    robots = {int(model.body(f'{robot.name}/base_link').rootid[0]) for robot in world.robots}
    ends = [*model.jnt_qposadr.tolist(), model.nq]
    return {
        model.body(body).name or f'body {body}': slice(ends[first], ends[first + count])
        for body, (first, count) in enumerate(
            zip(model.body_jntadr, model.body_jntnum, strict=True)
        )
        if count and int(model.body_rootid[body]) not in robots
    }


class PushedBodies:
    """Watches the loose bodies of a simulation."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._loose = loose_bodies(simulation.world)
        places = [place for part in self._loose.values() for place in range(part.start, part.stop)]
        self._places: Indices = np.array(places, dtype=np.int64)
        self.restart()

    def restart(self) -> None:
        """Use the poses of now as those before any push."""
        self._noted = self._simulation.data.qpos.copy()

    def moved(self) -> list[tuple[str, list[float]]]:
        """Return name and joint coordinates of what has moved; call it after every period."""
        qpos, places = self._simulation.data.qpos, self._places
        if not (np.abs(qpos[places] - self._noted[places]) > MOVED).any():
            return []
        found = []
        for name, part in self._loose.items():
            if (np.abs(qpos[part] - self._noted[part]) > MOVED).any():
                self._noted[part] = qpos[part]
                found.append((name, [round(value, _DIGITS) for value in qpos[part].tolist()]))
        return found
