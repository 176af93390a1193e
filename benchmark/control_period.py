# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print what a control period of the simulation costs, with and without what makes it cheaper.

Every kind follows the same course with the lab's driver, a second of simulated time in turn, so
that a busy machine is the same for all. Printed is the CPU time of `Simulation.advance`, then of
the whole period of a course that is graded (with driver and record), each as the median over all
seconds and as part of bare `mj_step` in the same world: over 100 % is faster than that, which
looks at every obstacle. The paths must be the same, bit for bit; exit status 1 if they are not.

Run it with:  ./lab exec python3 benchmark/control_period.py [COURSE]
"""

from argparse import ArgumentParser
from pathlib import Path
from statistics import median
import sys
from tempfile import TemporaryDirectory
import time

from husky_course.robot import RobotStart
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive import Drive
from husky_driver.motion import Odometry
from husky_sim.recording import RunRecorder
from husky_sim.robot.broadphase import BroadPhase
from husky_sim.robot.tyres import Tyres
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds, load_world
import mujoco

from husky_sim.config import CONTROL_PERIOD_SEC, FLOORS, SimulationConfig

WORLD = str(default_worlds() / 'playpen.xml')
COURSE = Path(__file__).parents[1] / 'config' / 'waypoints' / 'central_barrier.yaml'
IN_TURN = round(1.0 / CONTROL_PERIOD_SEC)


class Everything(BroadPhase):
    """Leaves nothing out."""

    def update(self) -> None:
        pass


class Bare:
    """The physics of a robot that drives in a circle, and nothing else."""

    def __init__(self) -> None:
        self._world = load_world(WORLD, [RobotStart()])
        self._data = mujoco.MjData(self._world.model)
        Tyres(self._world, self._data, FLOORS['asphalt'])  # the contacts of the simulator
        self._data.ctrl[:] = 2.0, 4.0, 2.0, 4.0
        self.period_us: list[float] = []

    def go_on(self) -> bool:
        begin_sec = time.process_time()
        mujoco.mj_step(self._world.model, self._data, IN_TURN * self._world.steps_per_period)
        self.period_us.append((time.process_time() - begin_sec) / IN_TURN * 1e6)
        return True


class Kind:
    """A drive of the course in a simulation of its own."""

    def __init__(
        self, name: str, course: Path, folder: str, *, visual: bool, everything: bool
    ) -> None:
        self.name = name
        self.simulation = Simulation(SimulationConfig(world=WORLD), visual=visual)
        self._recorder = RunRecorder(self.simulation, Path(folder, name))
        if everything:
            self.simulation.broadphase = Everything(self.simulation.world, self.simulation.data)
        self._drive = Drive(plan_route(load_course(str(course))))
        self.period_us: list[float] = []
        self.whole_us: list[float] = []

    def go_on(self) -> bool:
        """Drive for a second; tell whether the drive goes on."""
        simulation = self.simulation
        (robot,) = simulation.robots
        took_sec, whole_sec = 0.0, time.process_time()
        for _ in range(IN_TURN):
            pose = robot.filtered
            command = self._drive.step(
                Odometry(
                    simulation.time_sec,
                    *(pose.x, pose.y, pose.yaw, pose.speed_m_s, pose.yaw_rate_rad_s),
                )
            )
            if command is None:
                return False
            robot.controller.command(*command, time_sec=simulation.time_sec)
            begin_sec = time.process_time()
            simulation.advance()
            took_sec += time.process_time() - begin_sec
            self._recorder.append()
        self.whole_us.append((time.process_time() - whole_sec) / IN_TURN * 1e6)
        self.period_us.append(took_sec / IN_TURN * 1e6)
        return True


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('course', metavar='COURSE', nargs='?', type=Path, default=COURSE)
    course = parser.parse_args().course
    if not course.is_file():
        parser.error(f'{course}: no such file')
    bare = Bare()
    with TemporaryDirectory() as folder:
        kinds = [
            Kind('every obstacle looked at', course, folder, visual=True, everything=True),
            Kind('far obstacles left out', course, folder, visual=True, everything=False),
            Kind('and what is only seen', course, folder, visual=False, everything=False),
        ]
        everyone: list[Bare | Kind] = [bare, *kinds]
        driving = True
        while driving:
            driving = {each.go_on() for each in everyone} == {True}
    physics_us = median(bare.period_us)
    print(f'{"median":<26} {"advance":>10} {"of bare":>8} {"whole":>10} {"of bare":>8}')
    print(f'{"bare mj_step":<26} {physics_us:>7.0f} us')
    for kind in kinds:
        period_us, whole_us = median(kind.period_us), median(kind.whole_us)
        print(
            f'{kind.name:<26} {period_us:>7.0f} us {physics_us / period_us:>8.0%} '
            f'{whole_us:>7.0f} us {physics_us / whole_us:>8.0%}'
        )
    ends = {kind.simulation.robots[0].state for kind in kinds}
    if len(ends) > 1:
        print(f'the drives ended apart: {ends}')
    return int(len(ends) > 1)


if __name__ == '__main__':
    sys.exit(main())
