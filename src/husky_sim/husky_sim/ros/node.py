# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulate Huskies in a playpen, as a ROS 2 node."""

from collections.abc import Callable
from dataclasses import dataclass
import gc
import sys
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from husky_course.printable import printable
from husky_runtime.domains import DomainError, lock_simulator
from husky_runtime.executor import future_of_signal, spin
from husky_runtime.node_parser import NodeParser
from husky_runtime.shared_memory import (
    check_shared_memory,
    OF_A_SIMULATOR_MB,
    sends_by_shared_memory,
)
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.timer import Timer
from rclpy.utilities import remove_ros_args

from husky_sim.errors import SettingError, SimulatorError
from husky_sim.messages.messages import time_message
from husky_sim.recording.recorder import open_recorder
from husky_sim.ros.diagnostics import battery_statuses, PaceWatch
from husky_sim.ros.diagnostics import PERIOD_SEC as DIAGNOSTICS_PERIOD_SEC
from husky_sim.ros.interference import Interference, InterferenceWatch
from husky_sim.ros.pace import FreePace, Lockstep, Pace, Periods
from husky_sim.ros.parameters import (
    FACTOR,
    passed_over,
    read_factor,
    read_run,
    read_simulation,
    SETTINGS,
    SettingsNode,
)
from husky_sim.ros.simulation_services import add_simulation_services, ControlServices
from husky_sim.ros.simulation_topics import SimulationTopics
from husky_sim.scene_topic import SceneTopic
from husky_sim.simulation import Simulation

# How many looks, one a second, until who is waited for is told: drivers that are started together
# come one after the other, and the first of them when somebody has typed its command.
WAITING_LOOKS = 3
WAITING_LOOKS_FOR_ALL = 10


@dataclass(frozen=True)
class Trial:
    """
    A run that is graded: the controller meets what a real robot offers, and nothing else.

    No true pose, no collisions, no services, no parameters.
    """

    new_pace: Callable[[Periods], Pace]  # how its time passes
    on_period: Callable[[], object]  # called after each control period


class SimulatorNode(SettingsNode):
    """Simulates the robots of a world and publishes their topics."""

    def __init__(self, trial: Trial | None = None, **arguments: Any) -> None:
        """
        Read the parameters and load the world.

        :param arguments: what `rclpy.node.Node` takes: context, parameter_overrides, ...
        :raises SimulatorError: if a parameter, the world or a start pose cannot be used, or if
            another simulator runs in the domain.
        """
        context = arguments.get('context') or rclpy.get_default_context()
        self._lock = lock_simulator(context.get_domain_id())
        arguments.setdefault('automatically_declare_parameters_from_overrides', True)
        arguments.setdefault('start_parameter_services', trial is None)
        super().__init__('husky_sim', **arguments)
        self._run = read_run(self)
        config = read_simulation(self, self._run)
        for hint in passed_over(self, config) if trial is None else ():
            self.get_logger().warning(hint)
        self.simulation = Simulation(config, visual=config.sensors.camera_rate_hz > 0.0)
        self._record = open_recorder(self.simulation, self._run.record, self.get_logger().error)
        self.over: Future[None] = Future()
        self.paused = False  # time stands still
        self._waited_for: list[str] = []  # robots whose drivers lockstep waited for, at that look
        self._looks_at_waiting = 0  # while these were the same
        self._periods_looked_at = 0
        self._has_broken_down = False  # the physics, in this run
        self._topics = SimulationTopics(
            self,
            self.simulation,
            on_command=self._on_command,
            on_commander=lambda *event: self._interference.check_commands(*event),
            interface=self._run.interface,
            as_real=trial is not None,
        )
        self._interference = InterferenceWatch(
            self,
            ours=self._topics.own_topics,
            commands=self._topics.command_topics,
            on_found=self._on_interference,
        )
        self._on_period = trial.on_period if trial else self._show
        if trial is None:
            self._scene = SceneTopic(self, self.simulation, is_paused=lambda: self.paused)
            ControlServices(self, self)
            add_simulation_services(self, self)
        self._steady = RosClock(clock_type=ClockType.STEADY_TIME)
        self._pace = trial.new_pace(self) if trial else self._asked_pace()
        self._timer = self._new_timer()
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._watch = PaceWatch(self.simulation)
        self.create_timer(DIAGNOSTICS_PERIOD_SEC, self._on_diagnose, clock=self._steady)
        self.add_on_set_parameters_callback(self._on_set_parameters)
        obstacles = len(self.simulation.world.names) - len(config.robots)
        self.get_logger().info(
            f'{self._run.world}: {obstacles} obstacle{"" if obstacles == 1 else "s"}, '
            f'{", ".join(robot.name for robot in config.robots)}; '
            f'{self._pace}'
        )

    def _on_set_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == FACTOR.name:
                try:
                    self._change_pace(read_factor(parameter.value))
                except SettingError as error:
                    return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _asked_pace(self) -> Pace:
        run = self._run
        if run.lockstep:
            return Lockstep(self, run.real_time_factor, limited=run.limit_sec > 0.0)
        return FreePace(self, run.real_time_factor)

    def _change_pace(self, factor: float) -> None:
        self.destroy_timer(self._timer)
        self._pace.change(factor)
        self._timer = self._new_timer()
        self._watch.restart()
        self.get_logger().info(str(self._pace))

    def _new_timer(self) -> Timer:
        return self.create_timer(self._pace.tick_sec, self._on_tick, clock=self._steady)

    def _on_tick(self) -> None:
        if not self.paused:
            self._pace.tick()

    def _on_command(self) -> None:
        if not self.paused:
            self._pace.on_command()

    @property
    def has_drivers(self) -> bool:
        """Whether every robot's odometry has a subscription, and its commands a publisher."""
        return self._topics.has_drivers

    @property
    def has_followers(self) -> bool:
        """Whether any odometry of every robot has a subscription."""
        return self._topics.has_followers

    @property
    def has_commanders(self) -> bool:
        """Whether the commands of every robot have a publisher."""
        return self._topics.has_commanders

    @property
    def commanded(self) -> bool:
        """Whether every robot was commanded since the last control period."""
        return self._topics.commanded

    def publish(self) -> None:
        """Publish the last control period."""
        self._topics.publish()

    def publish_to_newcomers(self) -> None:
        """Publish it again of the robots whose driver may not have it."""
        self._topics.publish_to_newcomers()

    def publish_clock(self) -> None:
        """Tell the time on /clock."""
        self._topics.publish_clock()

    def advance(self, *, tells_time: bool = True) -> None:
        """
        Advance by one control period and publish it, unless the run is over.

        :param tells_time: also on /clock; else call `publish_clock` later.
        """
        if self.over.done():
            return
        self._topics.forget_commands()
        self.simulation.advance()
        if self._record is not None:
            self._record.append()
        self._topics.publish(tells_time=tells_time)
        if 0.0 < self._run.limit_sec <= self.simulation.time_sec:
            self.end(f'time is up after {self._run.limit_sec:g} s of simulated time')
        self._topics.warn_of_timeouts()
        self._topics.warn_of_empty_batteries()
        self._topics.warn_of_turned_over()
        self._on_period()

    def _show(self) -> None:
        self._scene.append()

    def end(self, why: str) -> None:
        """End the run, which its driver should have ended before."""
        if not self.over.done():
            self.get_logger().error(f'the run ends: {why}')
            self.over.set_result(None)

    def _on_interference(self, found: Interference) -> None:
        self.get_logger().error(str(found))
        if self._record is not None:
            self._record.disturb(self.simulation.time_sec, found.where, found.nodes)

    def _on_diagnose(self) -> None:
        waits = self.paused or self._pace.waits
        status = self._watch.status(self._pace.pacer, self._pace.factor, waits=waits)
        batteries = battery_statuses(self.simulation.robots)
        message = DiagnosticArray(status=[status, *batteries])
        message.header.stamp = time_message(self.simulation.stamp)
        self._diagnostics.publish(message)
        self._topics.warn_of_other_types()
        self._tell_of_breakdown()
        self._tell_who_waits()

    def _tell_who_waits(self) -> None:
        """Log, once a wait, whose drivers lockstep waits for."""
        before, self._periods_looked_at = self._periods_looked_at, self.simulation.periods
        if not isinstance(self._pace, Lockstep) or self.paused:
            self._waited_for = []
            return
        if self._pace.has_begun:
            lack = self._topics.without_command if before == self.simulation.periods else []
            why = 'in lockstep time waits for a command for each robot; no driver answers of '
        else:
            lack = self._topics.without_driver
            why = (
                'in lockstep time begins when each robot has a driver, which reads its '
                'odometry/filtered and publishes its commands; so far nobody drives '
            )
        self._looks_at_waiting = self._looks_at_waiting + 1 if lack == self._waited_for else 1
        self._waited_for = lack
        for_all = len(lack) == len(self.simulation.robots)
        if lack and self._looks_at_waiting == (
            WAITING_LOOKS_FOR_ALL if for_all else WAITING_LOOKS
        ):
            self.get_logger().warning(f'{why}{", ".join(lack)}')

    def _tell_of_breakdown(self) -> None:
        """Log, once a run, that the physics has failed; seldom, because it takes time to look."""
        what = '' if self._has_broken_down else self.simulation.breakdown
        if what:
            self._has_broken_down = True
            self.get_logger().error(printable(what))

    @property
    def at_start(self) -> bool:
        """Whether no time has passed since the start or the last reset."""
        return self.simulation.periods == 0

    @property
    def time_sec(self) -> float:
        """Return the simulated time."""
        return self.simulation.time_sec

    def pause(self, paused: bool) -> None:
        """Stop time, or continue."""
        self.paused = paused
        self._pace.pacer.restart()
        self._watch.restart()

    def reset(self) -> None:
        """Put everything back as it was at the start."""
        self.simulation.reset()
        self._has_broken_down = False
        if self._record is not None:
            self._record.restart()
        self._interference.restart()
        self._pace.begin_again()
        self._watch.restart()
        self._topics.forget_commands()
        if not self._run.lockstep:
            self._topics.publish()
        self.get_logger().info('everything is back at its start')

    def destroy_node(self) -> None:
        """End the record, then release everything; may be called twice."""
        if self._record is not None:
            self._interference.check(at_the_end=True)
            self._record.close()
            self._record = None
        self._topics.close()
        super().destroy_node()
        self._lock.close()


def main(args: list[str] | None = None) -> int:
    """Run the simulator until it is interrupted."""
    words = remove_ros_args(sys.argv if args is None else args)[1:]
    NodeParser('husky_sim', __doc__, SETTINGS).parse_args(words)
    try:
        if sends_by_shared_memory():
            check_shared_memory(OF_A_SIMULATOR_MB)
    except ValueError as error:
        print(f'husky_sim: {error}', file=sys.stderr)
        return 2
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    interrupted = future_of_signal()
    node: SimulatorNode | None = None
    try:
        node = SimulatorNode()
        gc.freeze()  # no long garbage collection of what is there now during a run
        node.over.add_done_callback(lambda _: interrupted.done() or interrupted.set_result(None))
        spin(node, until=interrupted)
    except (SimulatorError, DomainError) as error:
        print(printable(f'husky_sim: {error}'), file=sys.stderr)
        return 2
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
