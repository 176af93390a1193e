# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics by which one robot is commanded."""

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from std_msgs.msg import Bool

from husky_sim.messages.unpacked_numbers import reader_of
from husky_sim.ros import clearpath
from husky_sim.ros.interference import UNKNOWN_NAME
from husky_sim.simulation import SimulatedRobot, Simulation

_NAMES = {Twist: 'geometry_msgs/msg/Twist', TwistStamped: 'geometry_msgs/msg/TwistStamped'}
_Found = Callable[[str, int], None]
_NAME_LOOKS = 2  # how many looks, one a second, to wait for the name of a node


class CommandTopics:
    """
    Takes the commands of a robot, and its emergency stop.

    :param namespace: before every topic; empty for the only robot, ending in / for one of many.
    :param interface: lab, or clearpath: the stamped commands of a real robot as well.
    :param on_command: called after every command was taken.
    :param on_commander: called with a topic of commands when a publisher of it comes or goes, and
        with how many there were at the same time.
    """

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        robot: SimulatedRobot,
        namespace: str,
        qos: QoSProfile,
        interface: str,
        on_command: Callable[[], None],
        *,
        on_commander: _Found,
    ) -> None:
        self.commanded = False  # since it was last set to False
        self.has_newcomer = True  # somebody who is to command it has come, and not done so yet
        self._robot = robot
        self._simulation = simulation
        self._on_command = on_command
        self._logger = node.get_logger()
        self._nameless_looks = 0
        self._read = reader_of(Twist, 'linear.x', 'angular.z')
        takes: list[tuple[Any, str, Callable[[Any], None], bool]] = [
            (Twist, 'husky_velocity_controller/cmd_vel', self._take_bytes, True)
        ]
        if interface == clearpath.NAME:
            stamped = clearpath.StampedCommands(
                self._take, lambda: simulation.time_sec, robot.name, self._logger
            )
            takes.append((TwistStamped, clearpath.COMMANDS, stamped.on_message, False))
        self._subscriptions: list[tuple[Subscription, str]] = [
            (
                node.create_subscription(
                    kind,
                    f'{namespace}{topic}',
                    callback,
                    qos,
                    raw=raw,
                    event_callbacks=self._watch(
                        node.resolve_topic_name(f'{namespace}{topic}'), on_commander
                    ),
                ),
                _NAMES[kind],
            )
            for kind, topic, callback, raw in takes
        ]
        # As the Husky's twist_mux has it: while true, no command reaches the wheels.
        node.create_subscription(Bool, f'{namespace}e_stop', self._on_e_stop, qos)
        self._other_types: set[str] = set()

    @property
    def topics(self) -> list[str]:
        """Return the names of the topics on which commands are taken."""
        return [subscription.topic_name for subscription, _ in self._subscriptions]

    def is_commanded(self) -> bool:
        """Return whether the commands have a publisher."""
        return any(each.get_publisher_count() > 0 for each, _ in self._subscriptions)

    def _watch(self, topic: str, on_commander: _Found) -> SubscriptionEventCallbacks:
        def on_matched(event: Any) -> None:
            self.has_newcomer |= event.total_count_change > 0
            on_commander(topic, most_at_once(event))

        return SubscriptionEventCallbacks(matched=on_matched)

    def _on_e_stop(self, message: Bool) -> None:
        robot = self._robot
        if message.data != robot.is_stopped:
            robot.is_stopped = message.data
            what = 'emergency stop' if robot.is_stopped else 'emergency stop released'
            self._logger.warning(f'{robot.name}: {what}')
        if robot.is_stopped:
            robot.controller.command(0.0, 0.0, time_sec=self._simulation.time_sec)

    def _take_bytes(self, data: bytes) -> None:
        try:
            speed, yaw_rate = self._read(data)
        except RuntimeError as error:  # rclpy's RMWError
            self._logger.error(
                f'{self._robot.name}: bytes that are no {_NAMES[Twist]} were no command: {error}',
                throttle_duration_sec=1.0,
            )
            return
        self._take(speed, yaw_rate)

    def _take(self, speed: float, yaw_rate: float) -> None:
        if self._robot.is_stopped:
            speed = yaw_rate = 0.0
        try:
            self._robot.controller.command(speed, yaw_rate, time_sec=self._simulation.time_sec)
        except ValueError as error:
            self._logger.error(f'{self._robot.name}: {error}', throttle_duration_sec=1.0)
        self.commanded = True
        self.has_newcomer = False
        self._on_command()

    def warn_of_other_types(self, node: Node) -> None:
        """
        Log an error, once, for a publisher of commands with another message type.

        DDS does not connect the two, so the robot would not move. Most often it is a TwistStamped,
        which Jazzy's own controllers take.
        """
        for subscription, taken in self._subscriptions:
            topic = subscription.topic_name
            for publisher in node.get_publishers_info_by_topic(topic):
                kind = publisher.topic_type
                if kind != taken and kind not in self._other_types:
                    nameless = UNKNOWN_NAME in publisher.node_name
                    if nameless and self._nameless_looks < _NAME_LOOKS:
                        self._nameless_looks += 1
                        continue
                    self._other_types.add(kind)
                    self._logger.error(
                        f'{publisher.node_name} publishes {kind} on {topic}, which nobody hears; '
                        f'publish {taken}'
                    )


def most_at_once(event: Any) -> int:
    """Return how many were matched at the same time since the last event of a subscription."""
    before = event.current_count - event.current_count_change
    return int(before + event.total_count_change)
