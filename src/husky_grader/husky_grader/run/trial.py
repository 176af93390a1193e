# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The trusted half of a graded run, a process of its own: the simulator, and who decides its end.

The referee sees the true pose of every control period, which no topic carries. What happens is
told in a file that the controller cannot reach: see `told`. SIGUSR1 says that the
controller's process has ended.
"""

from argparse import ArgumentParser
from collections.abc import Sequence
import gc
from pathlib import Path
import signal
import sys

from husky_course.frames import to_odom
from husky_course.route import plan_route, Route
from husky_course.waypoints import load_course
from husky_runtime.command_line import BAD_INPUT
from husky_runtime.domains import DomainError
from husky_runtime.executor import future_of_signal, spin
from husky_sim.errors import SimulatorError
from husky_sim.simulator_node import Pace, Periods, SimulatorNode, Trial
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from husky_grader.run.answering import Answering
from husky_grader.run.referee import Referee
from husky_grader.run.rest import Resting
from husky_grader.run.told import tell, Told
from husky_grader.run.trusted import limit_memory
from husky_grader.run.watcher import GraphWatcher

LOOK_SEC = 0.5  # wall time between two looks at the graph, and two times of telling
HOPELESS_LOOKS = 7  # so many in a row must see a mistake on the graph


class TrialRun:
    """
    A simulator with a referee.

    :param interface: of the simulator: lab or clearpath.
    :param factor: simulated seconds a second for a controller that is not in lockstep.
    :param told: the file that says what happens.
    :param controller: the file in which the number of its first process will be.
    :raises SimulatorError: if the world cannot be used.
    """

    def __init__(
        self,
        route: Route,
        record: str,
        *,
        world: str,
        interface: str,
        factor: float,
        told: Path,
        controller: Path,
    ) -> None:
        self._told = told
        self._factor = factor
        self._resting = Resting(controller)
        self._referee = Referee(route)
        self._ending = ''
        self._count = 0
        self.node = SimulatorNode(
            Trial(self._new_pace, self._on_period),
            parameter_overrides=[
                Parameter('record', value=record),
                Parameter('world', value=world),
                Parameter('interface', value=interface),
                Parameter('start_type_description_service', value=False),
            ],
        )
        self._graph = GraphWatcher(self.node, interface)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.node.create_timer(LOOK_SEC, self._on_look, clock=steady)
        signal.signal(signal.SIGUSR1, lambda *_: self._pace.leave_alone())
        self._tell()

    def _new_pace(self, periods: Periods) -> Pace:
        self._pace = Answering(periods, self._factor, self._resting.at_rest)
        return self._pace

    def _on_period(self) -> None:
        (robot,) = self.node.simulation.robots
        state = robot.state
        ending = self._referee.over(
            self.node.time_sec,
            to_odom(robot.start.pose, state.position[0], state.position[1]),
            speed_m_s=state.velocity[0],
            yaw_rate_rad_s=state.angular_velocity[2],
            running=not self._pace.alone,
        )
        if ending:
            self._end(ending)

    def _on_look(self) -> None:
        self._graph.look()
        if not self._referee.started and self._graph.unheard_looks >= HOPELESS_LOOKS:
            self._end('its commands cannot be heard')
        self._tell()

    def _end(self, ending: str) -> None:
        if not self.node.over.done():
            self._ending = ending
            self.node.over.set_result(None)

    def close(self) -> None:
        """End the record, then tell how the run ended."""
        self.node.destroy_node()
        self._tell(self._ending or 'the grader was interrupted')

    def _tell(self, ending: str = '') -> None:
        self._count += 1
        tell(
            self._told,
            Told(
                count=self._count,
                time_sec=self.node.time_sec,
                waypoints_left=self._referee.waypoints_left,
                pace=str(self._pace),
                ending=ending,
                notes=self._graph.reasons,
                unsent=[] if self._pace.has_heard else self._graph.unsent,
            ),
        )


def main(args: Sequence[str] | None = None) -> int:
    """Run the trial to its end."""
    parser = ArgumentParser(prog='trial', description=__doc__)
    parser.add_argument('--waypoints', required=True)
    parser.add_argument('--record', required=True)
    parser.add_argument('--told', required=True, type=Path)
    parser.add_argument('--controller', required=True, type=Path)
    parser.add_argument('--world', default='')
    parser.add_argument('--interface', default='lab')
    parser.add_argument('--real-time-factor', type=float, default=1.0)
    options = parser.parse_args(args)
    limit_memory()
    route = plan_route(load_course(options.waypoints))
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    interrupted = future_of_signal()
    run: TrialRun | None = None
    try:
        run = TrialRun(
            route,
            options.record,
            world=options.world,
            interface=options.interface,
            factor=options.real_time_factor,
            told=options.told,
            controller=options.controller,
        )
        gc.freeze()  # no long garbage collection of what is there now during a run
        run.node.over.add_done_callback(
            lambda _: interrupted.done() or interrupted.set_result(None)
        )
        spin(run.node, until=interrupted)
    except (SimulatorError, DomainError) as error:
        tell(options.told, Told(failure=str(error)))
        return BAD_INPUT
    finally:
        if run is not None:
            run.close()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
