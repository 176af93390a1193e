# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print what a control period of the simulation costs, with and without what makes it cheaper.

Every kind follows the same course with the lab's driver, a second of simulated time in turn, so
that a busy machine is the same for all. Printed is the CPU time of `Simulation.advance`: the
median over all seconds, and its share of the first kind's. The paths must be the same, bit for
bit; exit status 1 if they are not.

Run it with:  ./lab exec python3 benchmark/control_period.py [COURSE]
"""

from pathlib import Path
from statistics import median
import sys
import time

from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive import Drive
from husky_driver.motion import Odometry
from husky_sim.robot.broadphase import BroadPhase
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds

from husky_sim.config import CONTROL_PERIOD_SEC, SimulationConfig

COURSE = Path(__file__).parents[1] / 'config' / 'waypoints' / 'central_barrier.yaml'
IN_TURN = round(1.0 / CONTROL_PERIOD_SEC)


class Everything(BroadPhase):
    """Leaves nothing out."""

    def update(self) -> None:
        pass


class Kind:
    """A drive of the course in a simulation of its own."""

    def __init__(self, name: str, course: Path, *, visual: bool, everything: bool) -> None:
        self.name = name
        world = str(default_worlds() / 'playpen.xml')
        self.simulation = Simulation(SimulationConfig(world=world), visual=visual)
        if everything:
            self.simulation.broadphase = Everything(self.simulation.world, self.simulation.data)
        self._drive = Drive(plan_route(load_course(str(course))))
        self.period_us: list[float] = []

    def go_on(self) -> bool:
        """Drive for a second; tell whether the drive goes on."""
        simulation = self.simulation
        (robot,) = simulation.robots
        took_sec = 0.0
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
        self.period_us.append(took_sec / IN_TURN * 1e6)
        return True


def main() -> int:
    course = Path(sys.argv[1]) if len(sys.argv) > 1 else COURSE
    kinds = [
        Kind('every obstacle looked at', course, visual=True, everything=True),
        Kind('far obstacles left out', course, visual=True, everything=False),
        Kind('and what is only seen', course, visual=False, everything=False),
    ]
    driving = True
    while driving:
        driving = {kind.go_on() for kind in kinds} == {True}
    first = median(kinds[0].period_us)
    for kind in kinds:
        middle = median(kind.period_us)
        print(f'{kind.name:<26} {middle:>7.0f} us {middle / first:>6.0%}')
    ends = {kind.simulation.robots[0].state for kind in kinds}
    if len(ends) > 1:
        print(f'the drives ended apart: {ends}')
    return int(len(ends) > 1)


if __name__ == '__main__':
    sys.exit(main())
