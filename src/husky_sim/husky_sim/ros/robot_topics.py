# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of one robot."""

from collections.abc import Callable
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Bool

from husky_sim.messages import messages
from husky_sim.messages.messages import Stamp
from husky_sim.messages.packed_message import Form
from husky_sim.robot.contacts import Collision
from husky_sim.ros.description import publish_description
from husky_sim.ros.sensor_topics import SensorTopics
from husky_sim.ros.transforms import create_transform_topics
from husky_sim.simulation import SimulatedRobot, Simulation

# Reliable and volatile: a subscription that is slow for a moment loses nothing.
QOS = QoSProfile(depth=10)

COUNT_SEC = 0.005
"""Wall time between two counts of subscriptions: a count costs as much as a message."""

_COMMAND_TYPE = 'geometry_msgs/msg/Twist'


class RobotTopics:
    """
    Publishes what a robot measures and takes its commands.

    :param namespace: before every topic; empty for the only robot, ending in / for one of many.
    :param on_command: called after every command was taken.
    :param on_commander: called with the topic of the commands when a publisher of it comes or
        goes, and with how many there were at the same time.
    :param form: in which packed messages are published.
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
        as_real: bool,
    ) -> None:
        self.robot = robot
        self.commanded = False
        self._simulation = simulation
        self._on_command = on_command
        self._form = form
        self._logger = node.get_logger()
        controller = f'{namespace}husky_velocity_controller'
        self._filtered = messages.FilteredOdometryMessage()
        self.filtered_publisher: Any = None
        if simulation.config.sensors.localization:
            self.filtered_publisher = node.create_publisher(
                Odometry, f'{namespace}odometry/filtered', QOS
            )
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
        self._rest: list[tuple[Any, Publisher]] = [
            (message, node.create_publisher(kind, topic, QOS)) for message, kind, topic in rest
        ]
        self._odometry: list[Publisher] = [
            publisher
            for message, publisher in ((self._filtered, self.filtered_publisher), *self._rest)
            if publisher is not None and isinstance(message, messages.OdometryMessage)
        ]
        self.odometry_topics = [publisher.topic_name for publisher in self._odometry]
        self._read = self._rest  # those of them that have subscriptions
        self._count_again_sec = 0.0
        self._sensors = SensorTopics(node, simulation, robot, namespace, QOS, form)
        self._rest += create_transform_topics(
            node, namespace, localization=self.filtered_publisher is not None
        )
        publish_description(node, namespace, simulation.world.husky)
        self.command_subscription: Subscription = node.create_subscription(
            Twist,
            f'{controller}/cmd_vel',
            self._on_cmd_vel,
            QOS,
            event_callbacks=SubscriptionEventCallbacks(
                matched=lambda event: on_commander(
                    self.command_subscription.topic_name, most_at_once(event)
                )
            ),
        )
        # As the Husky's twist_mux has it: while true, no command reaches the wheels.
        self._stop_subscription = node.create_subscription(
            Bool, f'{namespace}e_stop', self._on_e_stop, QOS
        )
        self._stopped = False
        self._other_types: set[str] = set()

    def _on_e_stop(self, message: Bool) -> None:
        if message.data != self._stopped:
            self._stopped = message.data
            what = 'emergency stop' if self._stopped else 'emergency stop released'
            self._logger.warning(f'{self.robot.name}: {what}')
        if self._stopped:
            self.robot.controller.command(0.0, 0.0, time_sec=self._simulation.time_sec)

    def _on_cmd_vel(self, message: Twist) -> None:
        speed, yaw_rate = message.linear.x, message.angular.z
        if self._stopped:
            speed = yaw_rate = 0.0
        try:
            self.robot.controller.command(speed, yaw_rate, time_sec=self._simulation.time_sec)
        except ValueError as error:
            self._logger.error(f'{self.robot.name}: {error}', throttle_duration_sec=1.0)
        self.commanded = True
        self._on_command()

    def warn_of_other_types(self, node: Node) -> None:
        """
        Log an error, once, for a publisher of commands with another message type.

        DDS does not connect the two, so the robot would not move. Most often it is a TwistStamped,
        which Jazzy's own controllers take.
        """
        topic = self.command_subscription.topic_name
        for publisher in node.get_publishers_info_by_topic(topic):
            kind = publisher.topic_type
            if kind != _COMMAND_TYPE and kind not in self._other_types:
                self._other_types.add(kind)
                self._logger.error(
                    f'{publisher.node_name} publishes {kind} on {topic}, which nobody hears; '
                    f'publish {_COMMAND_TYPE}'
                )

    def publish_filtered(self, stamp: Stamp) -> None:
        """Publish the odometry for the driver: first, so that the driver works meanwhile."""
        if self.filtered_publisher is not None:
            self._filtered.pack(stamp, self.robot)
            self.filtered_publisher.publish(self._form(self._filtered))

    def publish_rest(self, stamp: Stamp) -> None:
        """Publish everything else of a control period that has subscriptions."""
        now_sec = time.monotonic()
        if now_sec >= self._count_again_sec:
            self._count_again_sec = now_sec + COUNT_SEC
            self._read = [each for each in self._rest if each[1].get_subscription_count()]
        for message, publisher in self._read:
            message.pack(stamp, self.robot)
            publisher.publish(self._form(message))
        self._sensors.publish(stamp)

    def publish_collision(self, touch: Collision) -> None:
        """Publish one collision."""
        if self._collision_publisher is not None:
            self._collision_publisher.publish(messages.new_collision(touch))

    def has_driver(self) -> bool:
        """Return whether the odometry has a subscription and the commands have a publisher."""
        return self.is_commanded() and self.filtered_publisher.get_subscription_count() > 0

    def is_followed(self) -> bool:
        """Return whether any odometry has a subscription."""
        return any(publisher.get_subscription_count() for publisher in self._odometry)

    def is_commanded(self) -> bool:
        """Return whether the commands have a publisher."""
        return self.command_subscription.get_publisher_count() > 0

    def close(self) -> None:
        """Release what the node does not own; may be called twice."""
        self._sensors.close()


def most_at_once(event: Any) -> int:
    """Return how many were matched at the same time since the last event of a subscription."""
    before = event.current_count - event.current_count_change
    return int(before + event.total_count_change)
