# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the laser scanner would have measured in a recorded run, worked out from the poses."""

from collections.abc import Iterator, Sequence

from husky_course.outline import Outline
from husky_course.record import Record, RecordRefused
import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.recording.played_run import PlayedRun
from husky_sim.robot.husky import RobotState
from husky_sim.sensors.lidar import Lidar
from husky_sim.sensors.ray_scene import RayScene
from husky_sim.world.world import load_world

SCAN_RATE_HZ = 10.0
_SAME_M = 1e-6  # and rad: more than two machines may differ by
_EVERY = round(1.0 / (SCAN_RATE_HZ * CONTROL_PERIOD_SEC))  # rows of the record


class RecordedScans:
    """Scans of one robot, ten a second, without noise."""

    def __init__(self, run: Record, place: int) -> None:
        """
        Load the world of the run.

        :param place: which robot of the record.
        :raises SimulatorError: if the world is gone or cannot be used.
        :raises RecordRefused: if it is not the one that was driven.
        """
        self._run = run
        self._name = run.robots[place].name
        world = load_world(run.world, run.robots, visual=True)
        if not _are_same(world.obstacles, run.obstacles):
            raise RecordRefused(
                f'{run.file}: the obstacles of {run.world} are not those that were driven among; '
                'put back the world that was driven'
            )
        self._played = PlayedRun(run, world)
        self._model = world.model
        self._data = mujoco.MjData(world.model)
        self._lidar = Lidar(self._name, RayScene(world, self._data), None)

    def __iter__(self) -> Iterator[tuple[int, npt.NDArray[np.float32]]]:
        """Yield rows of the record with the ranges of all beams, as `Lidar.scan` returns them."""
        base = int(self._model.joint(f'{self._name}/base_joint').qposadr[0])
        still = (0.0, 0.0, 0.0)
        for row in range(0, len(self._run.rows), _EVERY):
            qpos = self._played.qpos(row)
            self._data.qpos[:] = qpos
            x, y, z, *orientation = qpos[base : base + 7].tolist()
            w, i, j, k = orientation
            state = RobotState((x, y, z), (w, i, j, k), still, still)
            yield row, self._lidar.scan(state, 1.0 / SCAN_RATE_HZ)


def _are_same(some: Sequence[Outline], others: Sequence[Outline]) -> bool:
    return len(some) == len(others) and all(map(_is_same, some, others))


def _is_same(one: Outline, other: Outline) -> bool:
    if (one.name, one.type) != (other.name, other.type):
        return False
    these, those = [(*each.size, each.x, each.y, each.yaw) for each in (one, other)]
    return np.allclose(these, those, rtol=0.0, atol=_SAME_M)
