# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulator as a ROS 2 node.

Time passes in one of three ways: at real_time_factor times the wall's pace, as fast as possible
(factor 0), or in lockstep, where each control period waits for the command that answers the
odometry of the one before.
"""

from dataclasses import replace
import gc
import sys
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from husky_runtime.domains import DomainError, lock_simulator
from husky_runtime.executor import future_of_signal, spin
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.timer import Timer

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.errors import SettingError, SimulatorError
from husky_sim.messages.messages import time_message
from husky_sim.recording.recorder import open_recorder
from husky_sim.ros.diagnostics import PaceWatch
from husky_sim.ros.diagnostics import PERIOD_SEC as DIAGNOSTICS_PERIOD_SEC
from husky_sim.ros.interference import Interference, InterferenceWatch
from husky_sim.ros.pacing import Pacer
from husky_sim.ros.parameters import FACTOR, read_factor, read_run, read_simulation
from husky_sim.ros.simulation_services import add_simulation_services, ControlServices
from husky_sim.ros.simulation_topics import SimulationTopics
from husky_sim.scene_topic import SceneTopic
from husky_sim.simulation import Simulation

REPEAT_SEC = 0.5
"""How often lockstep repeats its first odometry message, until the first command comes."""

HANGING_SEC = 60.0
"""
Without an answer to one message for so long, a run with a limit ends: the driver hangs.

Counted in polls of this node, which come later on a busy machine, as the answer does.
"""

_LOCKSTEP_POLL_SEC = 0.01
_SHORTEST_TICK_SEC = 0.001

# How long to simulate before the executor handles commands and services. As fast as possible: a
# return to the executor costs as much as half a control period. Behind the wall clock: long enough
# to catch up where a control period takes most of its time.
_TURN_SEC = 0.002
_CATCH_UP_TURN_SEC = 0.02


class SimulatorNode(Node):
    """Simulates the robots of a world and publishes their topics."""

    def __init__(self, **arguments: Any) -> None:
        """
        Read the parameters and load the world.

        :param arguments: what `rclpy.node.Node` takes: context, parameter_overrides, ...
        :raises SimulatorError: if a parameter, the world or a start pose cannot be used, or if
            another simulator runs in the domain.
        """
        context = arguments.get('context') or rclpy.get_default_context()
        self._lock = lock_simulator(context.get_domain_id())
        arguments.setdefault('automatically_declare_parameters_from_overrides', True)
        super().__init__('husky_sim', **arguments)
        self._run = read_run(self)
        config = read_simulation(self, self._run)
        self.simulation = Simulation(config)
        self._record = open_recorder(self.simulation, self._run.record, self.get_logger().error)
        factor = self._run.real_time_factor
        self._pacer = Pacer(period_sec=CONTROL_PERIOD_SEC, real_time_factor=factor or 1e9)
        self.over: Future[None] = Future()
        self.paused = False  # time stands still
        self._driven = False  # lockstep: the first odometry message is out
        self._answered = False  # lockstep: and was answered
        self._polls = 0  # lockstep: since the last message, without an answer
        self._sent_at_sec = 0.0
        self._topics = SimulationTopics(
            self,
            self.simulation,
            on_command=self._on_command,
            on_commander=lambda *event: self._interference.check_commands(*event),
        )
        self._interference = InterferenceWatch(
            self,
            ours=self._topics.own_topics,
            commands=self._topics.command_topics,
            on_found=self._on_interference,
        )
        self._scene = SceneTopic(self, self.simulation, is_paused=lambda: self.paused)
        ControlServices(self, self)
        add_simulation_services(self, self)
        self._steady = RosClock(clock_type=ClockType.STEADY_TIME)
        self._timer = self._new_timer()
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._watch = PaceWatch(self.simulation)
        self.create_timer(DIAGNOSTICS_PERIOD_SEC, self._on_diagnose, clock=self._steady)
        self.add_on_set_parameters_callback(self._on_set_parameters)
        self.get_logger().info(
            f'{self._run.world}: {len(self.simulation.world.obstacles)} obstacles, '
            f'{", ".join(robot.name for robot in config.robots)}; '
            f'{self._describe_pace()}'
        )

    def _tick_sec(self) -> float:
        if self._run.real_time_factor > 0.0:
            return max(CONTROL_PERIOD_SEC / self._run.real_time_factor, _SHORTEST_TICK_SEC)
        return _LOCKSTEP_POLL_SEC if self._run.lockstep else 0.0

    def _describe_pace(self) -> str:
        factor = self._run.real_time_factor
        pace = f'{factor:g} x real time' if factor > 0.0 else 'as fast as possible'
        return f'lockstep, {pace}' if self._run.lockstep else pace

    def _on_set_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == FACTOR.name:
                try:
                    self._change_pace(read_factor(parameter.value))
                except SettingError as error:
                    return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _change_pace(self, factor: float) -> None:
        self._run = replace(self._run, real_time_factor=factor)
        self.destroy_timer(self._timer)
        self._timer = self._new_timer()
        self.get_logger().info(self._describe_pace())

    def _new_timer(self) -> Timer:
        self._pacer.change(self._run.real_time_factor or 1e9, begin_sec=time.monotonic())
        return self.create_timer(self._tick_sec(), self._on_tick, clock=self._steady)

    def _on_tick(self) -> None:
        if self.paused:
            return
        if self._run.lockstep:
            self._continue_lockstep()
            return
        free = self._run.real_time_factor == 0.0
        now_sec = time.monotonic()
        end_sec = now_sec + (_TURN_SEC if free else _CATCH_UP_TURN_SEC)
        while now_sec < end_sec and (free or self._pacer.due(now_sec, most=1)):
            self._advance()
            now_sec = time.monotonic()

    def _on_command(self) -> None:
        if self._run.lockstep and not self.paused:
            self._answered = True
            self._advance_if_answered()

    def _continue_lockstep(self) -> None:
        """Begin, repeat the first message, or use a command that came too early."""
        if self._answered:
            self._advance_if_answered()
            self._polls += 1
            if self._run.limit_sec and self._polls * self._tick_sec() > HANGING_SEC:
                self._end(f'no command for {HANGING_SEC:g} s: the driver hangs')
            return
        now = time.monotonic()
        if not self._driven:
            if self._topics.has_drivers:
                self._driven = True
                self._topics.publish()
                self._sent_at_sec = now
        elif now - self._sent_at_sec >= REPEAT_SEC:
            self._topics.publish()
            self._sent_at_sec = now

    def _advance_if_answered(self) -> None:
        if not self._topics.commanded:
            return
        if self._run.real_time_factor > 0.0 and not self._pacer.due(time.monotonic(), most=1):
            return
        self._advance()

    def _advance(self) -> None:
        self._topics.forget_commands()
        self.simulation.advance()
        if self._record is not None:
            self._record.append()
        self._topics.publish()
        self._polls = 0
        if 0.0 < self._run.limit_sec <= self.simulation.time_sec:
            self._end(f'time is up after {self._run.limit_sec:.0f} s of simulated time')
        self._scene.append()
        self._topics.warn_of_timeouts()

    def _end(self, why: str) -> None:
        """End the run, which its driver should have ended before."""
        if not self.over.done():
            self.get_logger().error(f'the run ends: {why}')
            self.over.set_result(None)

    def _on_interference(self, found: Interference) -> None:
        self.get_logger().error(str(found))
        if self._record is not None:
            self._record.disturb(self.simulation.time_sec, found.topic, found.nodes)

    def _on_diagnose(self) -> None:
        waits = self.paused or self._run.lockstep
        status = self._watch.status(self._pacer, self._run.real_time_factor, waits=waits)
        message = DiagnosticArray(status=[status])
        message.header.stamp = time_message(self.simulation.stamp)
        self._diagnostics.publish(message)
        self._topics.warn_of_other_types()

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
        self._pacer.restart()

    def step(self) -> None:
        """Advance by one control period."""
        self._advance()

    def reset(self) -> None:
        """Put everything back as it was at the start."""
        self.simulation.reset()
        if self._record is not None:
            self._record.restart()
        self._pacer.restart()
        self._driven = self._answered = False
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
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    interrupted = future_of_signal()
    node: SimulatorNode | None = None
    try:
        node = SimulatorNode()
        gc.freeze()  # no long garbage collection of what is there now during a run
        node.over.add_done_callback(lambda _: interrupted.done() or interrupted.set_result(None))
        spin(node, until=interrupted)
    except (SimulatorError, DomainError) as error:
        print(f'husky_sim: {error}', file=sys.stderr)
        return 2
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
