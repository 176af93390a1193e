# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Publish where the links of a robot are: /tf for joints that move, /tf_static for the others."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import sys
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import TransformStamped
from node_program import own_words, run_node
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from tf2_py.motions import as_from_matrix, Motion
from tf2_ros import TransformBroadcaster

from robot_state_publisher.urdf import Joint, read_joints, UrdfError

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_MOST_HZ = 1000.0
_ALL_NAMED_WITHIN_NS = 5_000_000_000
_FREQUENCY = f'publish_frequency must be between 0 and {_MOST_HZ:g}'


class RobotStatePublisher(Node):
    """
    Publishes the transforms of the robot in its parameter robot_description.

    :param words: the arguments; the first is the URDF's file where the parameter is not given.
    :param options: of rclpy.node.Node.
    :raises UrdfError: the parameter, or the file, is no URDF.
    :raises ValueError: publish_frequency is out of its range.
    """

    def __init__(self, words: Sequence[str] = (), **options: Any) -> None:
        super().__init__('robot_state_publisher', **options)
        text = self.declare_parameter('robot_description', '').value
        if not text:
            text = self._read_file(words)
        if not 0.0 <= self.declare_parameter('publish_frequency', 20.0).value <= _MOST_HZ:
            raise ValueError(_FREQUENCY)
        self.declare_parameter('frame_prefix', '')
        self.declare_parameter('ignore_timestamp', False)
        self._moving: dict[str, Joint] = {}
        self._mimics: list[Joint] = []
        # Of each child the newest: the broadcaster of tf2_ros keeps the first for good.
        self._fixed: dict[str, TransformStamped] = {}
        self._published_ns: dict[str, int] = {}
        self._heard_ns = 0
        self._begin_ns: int | None = None  # of the joint states of this robot
        self._told: set[str] = set()
        self._broadcaster = TransformBroadcaster(self)
        self._tf_static = self.create_publisher(TFMessage, '/tf_static', _LATCHED)
        self._descriptions = self.create_publisher(String, 'robot_description', _LATCHED)
        self._describe(text)
        self.create_subscription(
            JointState,
            'joint_states',
            self._on_joint_states,
            qos_profile_sensor_data,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._on_set)

    def _read_file(self, words: Sequence[str]) -> str:
        if not words:
            raise UrdfError(
                'the parameter robot_description is empty; it has to be the text of a URDF, as by '
                "parameters=[{'robot_description': text}] of the Node in a launch file"
            )
        self.get_logger().warning(
            f'the parameter robot_description is empty; {words[0]} is read in its place, which '
            'a later ROS 2 will not do'
        )
        try:
            text = Path(words[0]).read_text(encoding='utf-8')
        except (OSError, UnicodeDecodeError) as error:
            raise UrdfError(f'{words[0]} cannot be read: {error}') from None
        self.set_parameters([Parameter('robot_description', value=text)])
        return text

    def _check(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == 'robot_description':
                try:
                    _joints_of(parameter.value)
                except UrdfError as error:
                    return SetParametersResult(reason=str(error))
            if parameter.name == 'publish_frequency' and not 0.0 <= parameter.value <= _MOST_HZ:
                return SetParametersResult(reason=_FREQUENCY)
        return SetParametersResult(successful=True)

    def _on_set(self, parameters: Sequence[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == 'robot_description':
                self._describe(parameter.value)

    def _describe(self, text: str) -> None:
        """Take over a URDF: publish it, and what of it stands still."""
        joints = _joints_of(text)
        self._moving = {joint.name: joint for joint in joints if joint.moves}
        self._mimics = [joint for joint in joints if joint.mimic]
        self._told.clear()
        self._begin_ns = None
        self._descriptions.publish(String(data=text))
        now = self.get_clock().now().to_msg()
        for joint in joints:
            if not joint.moves and joint.kind != 'floating':
                self._fixed[joint.child] = self._transform(joint, joint.origin, now)
        self._tf_static.publish(TFMessage(transforms=list(self._fixed.values())))
        self.get_logger().info('Robot initialized')

    def _transform(self, joint: Joint, motion: Motion, stamp: Stamp) -> TransformStamped:
        prefix = self.get_parameter('frame_prefix').value
        message = TransformStamped(child_frame_id=f'{prefix}{joint.child}')
        message.header.stamp = stamp
        message.header.frame_id = f'{prefix}{joint.parent}'
        to, turn = message.transform.translation, message.transform.rotation
        to.x, to.y, to.z = motion.translation
        turn.x, turn.y, turn.z, turn.w = as_from_matrix(motion.rotation)
        return message

    def _on_joint_states(self, message: JointState) -> None:
        if len(message.name) != len(message.position):
            self._tell(
                f'a JointState with {len(message.name)} names and {len(message.position)} '
                'positions is ignored'
            )
            return
        if message.header.stamp.sec < 0:
            self._tell('a JointState with a negative stamp is ignored')
            return
        self._tell_of_unknown(message.name)
        if not self._is_due(message):
            return
        # Of a joint that is named twice the first position counts, as upstream.
        positions = dict(zip(reversed(message.name), reversed(message.position), strict=True))
        for joint in self._mimics:
            if joint.mimic and joint.mimic.joint in positions:
                position = positions[joint.mimic.joint] * joint.mimic.multiplier
                positions.setdefault(joint.name, position + joint.mimic.offset)
        self._broadcaster.sendTransform(
            self._transform(joint, joint.motion(positions[name]), message.header.stamp)
            for name, joint in self._moving.items()
            if name in positions
        )
        stamp_ns = Time.from_msg(message.header.stamp).nanoseconds
        self._published_ns.update(dict.fromkeys(message.name, stamp_ns))
        self._tell_of_missing(message.name)

    def _is_due(self, message: JointState) -> bool:
        """Tell whether the joint that was published longest ago was so a period before."""
        now_ns = self.get_clock().now().nanoseconds
        if now_ns < self._heard_ns:
            self.get_logger().warning('time went back: all joints are published anew')
            self._published_ns.clear()
            self._begin_ns = None
        self._heard_ns = now_ns
        if self.get_parameter('ignore_timestamp').value:
            return True
        frequency_hz = self.get_parameter('publish_frequency').value
        period_ms = int(1000.0 / frequency_hz) if frequency_hz else 0
        last_ns = min([now_ns, *(self._published_ns.get(name, 0) for name in message.name)])
        stamp_ns = Time.from_msg(message.header.stamp).nanoseconds
        if stamp_ns == 0 and period_ms:
            self._tell(
                'a JointState without a stamp is not published: fill header.stamp, or set '
                'ignore_timestamp'
            )
        return stamp_ns >= last_ns + period_ms * 1_000_000

    def _tell_of_unknown(self, names: Sequence[str]) -> None:
        if names and not self._moving.keys() & {*names}:
            known = ', '.join(self._moving) or 'none'
            self._tell(
                f"joint_states names '{names[0]}', which moves nothing here; the joints in "
                f'robot_description that move: {known}'
            )

    def _tell_of_missing(self, names: Sequence[str]) -> None:
        """Tell of joints that no message has named, for their links have no transform."""
        if self._begin_ns is None:
            self._begin_ns = self._heard_ns
        if self._heard_ns - self._begin_ns < _ALL_NAMED_WITHIN_NS:
            return  # each message may name some of them
        links = {
            name: joint.child
            for name, joint in self._moving.items()
            if name not in self._published_ns and not joint.mimic
        }
        if links:
            unknown = [name for name in names if name not in self._moving]
            odd = f'; {", ".join(unknown)}, which it names, moves nothing here' if unknown else ''
            self._tell(
                f'joint_states has not named {", ".join(links)}, so that there is no transform '
                f'to {", ".join(links.values())}{odd}'
            )

    def _tell(self, what: str) -> None:
        """Warn of something once for each robot, not with every message."""
        if what not in self._told:
            self._told.add(what)
            self.get_logger().warning(what)


def _joints_of(text: str) -> list[Joint]:
    try:
        return read_joints(text)
    except UrdfError as error:
        raise UrdfError(f'robot_description: {error}') from None


def main() -> int:
    words = own_words(sys.argv)
    return run_node(lambda _: RobotStatePublisher(words), sys.argv)


if __name__ == '__main__':
    sys.exit(main())
