# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a simulation: those of every robot, and the clock."""

from collections.abc import Callable

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from husky_sim.messages.layouts import packed_messages
from husky_sim.messages.messages import ClockMessage
from husky_sim.messages.packed_message import proven_form
from husky_sim.ros.packed_topic import PackedTopic
from husky_sim.ros.robot_topics import QOS, RobotTopics
from husky_sim.simulation import Simulation


class SimulationTopics:
    """
    Publishes what a control period has changed, and takes the commands.

    :param on_command: called after every command was taken.
    :param on_commander: called with a topic of commands when a publisher of it comes or goes, and
        with how many there were at the same time.
    :param interface: lab, or clearpath: the topics of a real robot as well.
    :param as_real: publish only what a real robot measures: no true pose, no collisions.
    """

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        *,
        on_command: Callable[[], None],
        on_commander: Callable[[str, int], None],
        interface: str = 'lab',
        as_real: bool = False,
    ) -> None:
        self._node = node
        self._simulation = simulation
        form = proven_form(packed_messages(), node.get_logger())
        many = len(simulation.robots) > 1
        self._robots = [
            RobotTopics(
                node,
                simulation,
                robot,
                f'{robot.name}/' if many else '',
                on_command,
                form,
                on_commander=on_commander,
                interface=interface,
                as_real=as_real,
            )
            for robot in simulation.robots
        ]
        self._by_name = {topics.robot.name: topics for topics in self._robots}
        self._clock = PackedTopic(
            ClockMessage(), node.create_publisher(Clock, '/clock', QOS), form
        )

    @property
    def own_topics(self) -> list[str]:
        """Return the topics that the simulator alone should publish."""
        odometry = [name for topics in self._robots for name in topics.odometry_topics]
        return [self._clock.publisher.topic_name, *odometry]

    @property
    def command_topics(self) -> list[list[str]]:
        """Return, for each robot, the topics that one driver should publish."""
        return [topics.commands.topics for topics in self._robots]

    @property
    def has_drivers(self) -> bool:
        """Whether every robot's odometry has a subscription, and its commands a publisher."""
        return not self.without_driver

    @property
    def without_driver(self) -> list[str]:
        """Return the names of the robots that have none."""
        return [topics.robot.name for topics in self._robots if not topics.has_driver()]

    @property
    def has_followers(self) -> bool:
        """Whether any odometry of every robot has a subscription."""
        return all(topics.is_followed() for topics in self._robots)

    @property
    def has_commanders(self) -> bool:
        """Whether the commands of every robot have a publisher."""
        return all(topics.commands.is_commanded() for topics in self._robots)

    @property
    def commanded(self) -> bool:
        """
        Whether every robot was commanded since the last `forget_commands`.

        Of several, one whose driver has ended is not waited for.
        """
        waits = [topics for topics in self._robots if not topics.commands.commanded]
        if len(waits) == len(self._robots):
            return False
        return not any(topics.commands.is_commanded() for topics in waits)

    @property
    def without_command(self) -> list[str]:
        """Return the names of the robots that were not commanded since then."""
        return [topics.robot.name for topics in self._robots if not topics.commands.commanded]

    def forget_commands(self) -> None:
        """Wait for a new command for every robot."""
        for topics in self._robots:
            topics.commands.commanded = False

    def publish_clock(self) -> None:
        """Tell the time on /clock."""
        self._clock.pack(self._simulation.stamp)
        self._clock.publish()

    def publish(self, *, tells_time: bool = True) -> None:
        """
        Publish a control period, first the odometry for the driver.

        :param tells_time: also on /clock.
        """
        stamp = self._simulation.stamp
        for topics in self._robots:
            topics.publish_filtered(stamp)
        if tells_time:
            self.publish_clock()
        for topics in self._robots:
            topics.publish_rest(stamp)
        for touch in self._simulation.touches:
            self._by_name[touch.robot].publish_collision(touch)

    def publish_to_newcomers(self) -> None:
        """Publish the last control period again, of the robots whose driver may not have it."""
        stamp = self._simulation.stamp
        for topics in self._robots:
            if topics.commands.has_newcomer and topics.has_driver():
                topics.publish_filtered(stamp)
                topics.publish_rest(stamp)

    def warn_of_timeouts(self) -> None:
        """Log which robots have just begun to stop because no command came."""
        for robot in self._simulation.robots:
            if robot.command_timed_out:
                timeout_sec = robot.controller.config.command_timeout_sec
                self._node.get_logger().warning(
                    f'{robot.name}: no command for {timeout_sec:g} s '
                    '(command_timeout_sec); stopping'
                )

    def warn_of_empty_batteries(self) -> None:
        """Log which batteries have just run empty."""
        for robot in self._simulation.robots:
            if robot.battery_ran_empty:
                self._node.get_logger().warning(
                    f'{robot.name}: the battery is empty, so that the motors are off; reset the '
                    'simulation, or start it with a greater battery_charge'
                )

    def warn_of_turned_over(self) -> None:
        """Log which robots have just turned over."""
        for robot in self._simulation.robots:
            if robot.turned_over:
                x, y, _ = robot.state.position
                self._node.get_logger().warning(
                    f'{robot.name}: turned over at ({x:.2f}, {y:.2f}), as when it climbs an '
                    'obstacle; its wheels carry it no more: reset the simulation'
                )

    def warn_of_other_types(self) -> None:
        """Log which publishers of commands have another message type, each once."""
        for topics in self._robots:
            topics.commands.warn_of_other_types(self._node)

    def close(self) -> None:
        """Release what the node does not own; may be called twice."""
        for topics in self._robots:
            topics.close()
