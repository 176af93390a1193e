# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how fast the Gymnasium environment is, beside bare `mj_step` of the same world.

Every kind of environment is made by `gymnasium.make`, with all of its wrappers. The lab's driver
drives it around the course once; then the same actions are given again and again, each episode in
turn with the bare model, which is given the same wheel speeds, so that a busy machine is the same
for both. Printed is the CPU time of a control period of 20 ms (five physics steps): of `env.step`
and `env.reset` with all they do, the report at the end of an episode included. Frames are control
periods.

Run it with:  ./lab exec python3 benchmark/environment_speed.py [EPISODES]
"""

from argparse import ArgumentParser
from statistics import median
import sys
import time
from typing import Any

import gymnasium
from husky_course.robot import RobotStart
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive import Drive
from husky_driver.motion import Odometry
from husky_grader.playpen import default_course
from husky_sim.robot.tyres import Tyres
from husky_sim.world import load_world
import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.config import FLOORS

Array = npt.NDArray[np.float64]
KINDS: dict[str, dict[str, Any]] = {
    'no laser': {'laser_beams': 0},
    '90 beams at 10 Hz': {},
    '720 beams at 10 Hz': {'laser_beams': 720},
    '720 beams at 50 Hz': {'laser_beams': 720, 'laser_rate_hz': 50.0},
    'no laser, 5 periods a step': {'laser_beams': 0, 'frame_skip': 5},
    '90 beams, 5 periods a step': {'frame_skip': 5},
}


class Kind:
    """An environment, and a drive in it."""

    def __init__(self, settings: dict[str, Any]) -> None:
        self._env: gymnasium.Env[Any, Any] = gymnasium.make(
            'husky_gym:HuskyPlaypen-v0', **settings
        )
        self._actions: list[Array] = []
        self._wheel_speeds: list[Array] = []
        periods = settings.get('frame_skip', 1)
        simulation = self._env.unwrapped.husky.simulation  # type: ignore[attr-defined]
        drive = Drive(plan_route(load_course(default_course())))
        _, info = self._env.reset(seed=1)
        is_over = False
        while not is_over:
            command = drive.step(Odometry(info['time_sec'], *info['odometry'])) or (0.0, 0.0)
            self._actions.append(np.array([command[0], command[1] / 2.0], dtype=np.float32))
            _, _, ended, cut, info = self._env.step(self._actions[-1])
            self._wheel_speeds += [simulation.data.ctrl.copy()] * periods
            is_over = ended or cut
        self.score = info['score']
        self._world = load_world(simulation.config.world, [RobotStart()], visual=False)
        # The contacts of the simulator.
        Tyres(self._world, mujoco.MjData(self._world.model), FLOORS['asphalt'])

    def episode_us(self) -> float:
        """Return the CPU time of a control period in the environment."""
        begin_sec = time.process_time()
        self._env.reset(seed=1)
        for action in self._actions:
            self._env.step(action)
        return (time.process_time() - begin_sec) / len(self._wheel_speeds) * 1e6

    def bare_us(self) -> float:
        """Return that of the physics of the same drive, and nothing else."""
        model, data = self._world.model, mujoco.MjData(self._world.model)
        steps = self._world.steps_per_period
        begin_sec = time.process_time()
        for speeds in self._wheel_speeds:
            data.ctrl[:] = speeds
            mujoco.mj_step(model, data, steps)
        return (time.process_time() - begin_sec) / len(self._wheel_speeds) * 1e6


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('episodes', metavar='EPISODES', nargs='?', type=int, default=5)
    episodes = parser.parse_args().episodes
    print(f'{"":<28}{"a period":>10}{"bare":>10}{"of bare":>9}{"frames a second":>17}{"score":>7}')
    for name, settings in KINDS.items():
        kind = Kind(settings)
        turns = [(kind.bare_us(), kind.episode_us()) for _ in range(episodes)]
        bare_us, kind_us = (median(each) for each in zip(*turns, strict=True))
        print(
            f'{name:<28}{kind_us:>7.0f} us{bare_us:>7.0f} us{bare_us / kind_us:>9.0%}'
            f'{1e6 / kind_us:>17.0f}{kind.score:>7.1f}'
        )
    return 0


if __name__ == '__main__':
    sys.exit(main())
