# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of one robot."""

from collections.abc import Callable
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Imu, JointState

from husky_sim.messages import messages
from husky_sim.messages.messages import Stamp
from husky_sim.messages.packed_message import Form
from husky_sim.robot.contacts import Collision
from husky_sim.ros import clearpath
from husky_sim.ros.command_topics import CommandTopics
from husky_sim.ros.description import publish_description
from husky_sim.ros.packed_topic import PackedTopic
from husky_sim.ros.sensor_topics import SensorTopics
from husky_sim.ros.transforms import create_transform_topics
from husky_sim.simulation import SimulatedRobot, Simulation
from husky_sim.world import CLEARPATH_FRAMES, FIXED_FRAMES

# Reliable and volatile: a subscription that is slow for a moment loses nothing.
QOS = QoSProfile(depth=10)

COUNT_SEC = 0.005
"""
Wall time between two counts of the subscriptions of the only robot; with ten, ten times that.

A count costs half as much as a message without a reader, and there are as many of them.
"""


class RobotTopics:
    """
    Publishes what a robot measures; `commands` takes what it is told.

    :param namespace: before every topic; empty for the only robot, ending in / for one of many.
    :param on_command: called after every command was taken.
    :param on_commander: see CommandTopics.
    :param form: in which packed messages are published.
    :param interface: lab, or clearpath: the topics of a real robot as well.
    :param as_real: publish only what a real robot measures: no true pose, no collisions.
    """

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        robot: SimulatedRobot,
        namespace: str,
        on_command: Callable[[], None],
        form: Form,
        *,
        on_commander: Callable[[str, int], None],
        interface: str,
        as_real: bool,
    ) -> None:
        self.robot = robot
        controller = f'{namespace}husky_velocity_controller'
        filtered = messages.FilteredOdometryMessage()
        self._filtered: list[PackedTopic] = []
        as_clearpath = interface == clearpath.NAME
        if simulation.config.sensors.localization:
            self._filtered = [
                PackedTopic(
                    filtered, node.create_publisher(Odometry, f'{namespace}{topic}', QOS), form
                )
                for topic in ('odometry/filtered', *([clearpath.FILTERED] if as_clearpath else []))
            ]
        rest: list[tuple[Any, Any, str]] = [
            (messages.WheelOdometryMessage(), Odometry, f'{controller}/odom'),
            (messages.CommandMessage(), Twist, f'{controller}/cmd_vel_out'),
            (messages.ImuMessage(), Imu, f'{namespace}imu/data'),
            (messages.JointStateMessage(), JointState, f'{namespace}joint_states'),
        ]
        self._collision_publisher: Publisher | None = None
        if not as_real:
            truth = messages.GroundTruthMessage()
            rest.append((truth, Odometry, f'{namespace}ground_truth/odom'))
            self._collision_publisher = node.create_publisher(
                DiagnosticStatus, f'{namespace}collisions', QOS
            )
        self._rest = [
            PackedTopic(message, node.create_publisher(kind, topic, QOS), form)
            for message, kind, topic in rest
        ]
        if as_clearpath:
            self._rest += [
                PackedTopic(
                    each.message,
                    node.create_publisher(each.kind, namespace + each.topic, each.qos),
                    form,
                )
                for each in clearpath.measured()
            ]
        self._odometry = [
            *self._filtered,
            *(each for each in self._rest if isinstance(each.message, messages.OdometryMessage)),
        ]
        self.odometry_topics = [each.publisher.topic_name for each in self._odometry]
        self._read = self._rest  # those of them that have subscriptions
        self._count_sec = COUNT_SEC * len(simulation.robots)
        self._count_again_sec = 0.0
        self._sensors = SensorTopics(
            node, simulation, robot, namespace, QOS, form, interface=interface
        )
        fixed = FIXED_FRAMES | (CLEARPATH_FRAMES if as_clearpath else {})
        moving = create_transform_topics(
            node, namespace, localization=bool(self._filtered), fixed=fixed
        )
        self._rest += [PackedTopic(message, publisher, form) for message, publisher in moving]
        publish_description(node, namespace, simulation.world.husky, fixed)
        self.commands = CommandTopics(
            node,
            simulation,
            robot,
            namespace,
            QOS,
            interface,
            on_command,
            on_commander=on_commander,
        )

    def publish_filtered(self, stamp: Stamp) -> None:
        """Publish the odometry for the driver: first, so that the driver works meanwhile."""
        for topic in self._filtered:
            topic.pack(stamp, self.robot)
            topic.publish()

    def publish_rest(self, stamp: Stamp) -> None:
        """Publish everything else of a control period that has subscriptions."""
        now_sec = time.monotonic()
        if now_sec >= self._count_again_sec:
            self._count_again_sec = now_sec + self._count_sec
            self._read = [each for each in self._rest if each.is_read]
            self._sensors.count_subscriptions()
        for topic in self._read:
            topic.pack(stamp, self.robot)
            topic.publish()
        self._sensors.publish(stamp)

    def publish_collision(self, touch: Collision) -> None:
        """Publish one collision."""
        if self._collision_publisher is not None:
            self._collision_publisher.publish(messages.new_collision(touch))

    def has_driver(self) -> bool:
        """Return whether the odometry has a subscription and the commands have a publisher."""
        return self.commands.is_commanded() and any(topic.is_read for topic in self._filtered)

    def is_followed(self) -> bool:
        """Return whether any odometry has a subscription."""
        return any(topic.is_read for topic in self._odometry)

    def close(self) -> None:
        """Release what the node does not own; may be called twice."""
        self._sensors.close()
