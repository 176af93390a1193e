# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Publish a position for each joint of a robot that moves, so that all its frames are known."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
import sys
from typing import Any

from node_program import own_words, run_node
from rcl_interfaces.msg import ParameterDescriptor, ParameterType
from rclpy.exceptions import ParameterAlreadyDeclaredException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from joint_state_publisher.description import DescriptionError, Joint, read_joints
from joint_state_publisher.mimics import Follower, followers, MimicCycleError

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_QUANTITIES = ('position', 'velocity', 'effort')
_PARAMETERS = {
    'publish_default_efforts': (False, ParameterType.PARAMETER_BOOL),
    'publish_default_positions': (True, ParameterType.PARAMETER_BOOL),
    'publish_default_velocities': (False, ParameterType.PARAMETER_BOOL),
    'rate': (10, ParameterType.PARAMETER_INTEGER),
    'source_list': ([], ParameterType.PARAMETER_STRING_ARRAY),
    'use_mimic_tags': (True, ParameterType.PARAMETER_BOOL),
    'use_smallest_joint_limits': (True, ParameterType.PARAMETER_BOOL),
    'delta': (0.0, ParameterType.PARAMETER_DOUBLE),
}
_OF_DEPENDENT = ('parent', 'factor', 'offset')


class JointStatePublisher(Node):
    """
    Publishes where the joints of a robot are: at their zeros, or where other topics have them.

    `free_joints` has of each joint that follows none what is published, and its limits;
    `joint_list` the order of all; `dependent_joints` whom the others follow.

    :param description_file: URDF, SDF or COLLADA; None: it comes on the topic robot_description.
    :param options: of rclpy.node.Node.
    :raises DescriptionError: the file describes no robot.
    :raises ValueError: a parameter is wrong.
    """

    def __init__(self, description_file: str | Path | None = None, **options: Any) -> None:
        super().__init__(
            'joint_state_publisher',
            automatically_declare_parameters_from_overrides=True,
            **options,
        )
        for name, (default, kind) in _PARAMETERS.items():
            self.declare_ros_parameter(name, default, ParameterDescriptor(type=kind))
        self.free_joints: dict[str, dict[str, Any]] = {}
        self.joint_list: list[str] = []
        self.use_mimic = self.get_param('use_mimic_tags')
        self.use_small = self.get_param('use_smallest_joint_limits')
        self.pub_def_positions = self.get_param('publish_default_positions')
        self.pub_def_vels = self.get_param('publish_default_velocities')
        self.pub_def_efforts = self.get_param('publish_default_efforts')
        self.delta = _number(self.get_parameter('delta'))
        zeros = self.get_parameters_by_prefix('zeros')
        self.zeros = {name: _number(parameter) for name, parameter in zeros.items()}
        self._asked_to_follow = self.parse_dependent_joints()
        self.dependent_joints = dict(self._asked_to_follow)
        self._followers: dict[str, Follower] = {}
        self.robot_description_update_cb: Callable[[], None] | None = None
        self.source_update_cb: Callable[[], None] | None = None
        rate_hz = _number(self.get_parameter('rate'))
        if rate_hz <= 0.0:
            raise ValueError(f'rate={rate_hz:g}: it has to be above 0, in Hz')
        if description_file is None:
            self.get_logger().info(
                'Waiting for robot_description to be published on the robot_description topic...'
            )
        else:
            self._read_file(Path(description_file))
        self._connect(1.0 / rate_hz)

    def _read_file(self, path: Path) -> None:
        try:
            self.configure_robot(path.read_text(encoding='utf-8'))
        except OSError as error:
            raise DescriptionError(f'it cannot be read: {error.strerror}') from None
        except UnicodeDecodeError as error:
            raise DescriptionError(f'it is no text in UTF-8: {error}') from None

    def _connect(self, period_sec: float) -> None:
        self.create_subscription(String, 'robot_description', self.robot_description_cb, _LATCHED)
        self.sources = [
            self.create_subscription(JointState, topic, self.source_cb, 10)
            for topic in self._source_topics()
        ]
        self.pub = self.create_publisher(JointState, 'joint_states', 10)
        self.timer = self.create_timer(period_sec, self.timer_callback)

    def _source_topics(self) -> list[str]:
        topics = self.get_param('source_list')
        if isinstance(topics, list) and all(isinstance(topic, str) for topic in topics):
            return topics
        raise ValueError(f"source_list={topics!r}: it has to be a list of topics, as ['joints']")

    def get_param(self, name: str) -> Any:
        return self.get_parameter(name).value

    def declare_ros_parameter(
        self, name: str, default: Any, descriptor: ParameterDescriptor
    ) -> None:
        """Declare a parameter, but for one that was given, which is declared by then."""
        with suppress(ParameterAlreadyDeclaredException):
            self.declare_parameter(name, default, descriptor)

    def parse_dependent_joints(self) -> dict[str, dict[str, Any]]:
        """
        Return whom joints follow by the parameters dependent_joints.JOINT.parent and so on.

        :raises ValueError: the name of one is wrong, or a parent is missing.
        """
        found: dict[str, dict[str, Any]] = {}
        for name, parameter in self.get_parameters_by_prefix('dependent_joints').items():
            joint, _, key = name.rpartition('.')
            if key not in _OF_DEPENDENT:
                raise ValueError(
                    f"Invalid dependent_joint name '{name}': it has to be JOINT.parent, "
                    'JOINT.factor or JOINT.offset'
                )
            value = parameter.value if key == 'parent' else _number(parameter)
            found.setdefault(joint, {})[key] = value
        for joint, mimic in found.items():
            if 'parent' not in mimic:
                raise ValueError(
                    f"dependent_joints.{joint}: a parent is missing, by which '{joint}' goes"
                )
        return found

    def configure_robot(self, description: str) -> None:
        """
        Take over a robot.

        :raises DescriptionError: it is none; the one before stays.
        :raises SystemExit: its joints follow each other in a circle.
        """
        joints = read_joints(description, use_smallest_limits=self.use_small)
        self.get_logger().info('Got description, configuring robot')
        dependent = self._dependent(joints)
        free = {
            joint.name: self._at_zero(joint) for joint in joints if joint.name not in dependent
        }
        try:
            self._followers = followers(dependent, free)
        except MimicCycleError as error:
            self.get_logger().error(str(error))
            raise SystemExit(1) from None
        self.free_joints, self.dependent_joints = free, dependent
        self.joint_list = [joint.name for joint in joints]
        if self.robot_description_update_cb is not None:
            self.robot_description_update_cb()

    def _dependent(self, joints: list[Joint]) -> dict[str, dict[str, Any]]:
        """Return whom joints follow: as the description says, or else as parameters do."""
        dependent = {}
        for joint in joints:
            mimic = joint.mimic if self.use_mimic else None
            mimic = mimic or self._asked_to_follow.get(joint.name)
            if mimic is not None:
                dependent[joint.name] = mimic
        return dependent

    def _at_zero(self, joint: Joint) -> dict[str, Any]:
        zero = self.zeros.get(joint.name)
        if zero is None:
            outside = joint.lower > 0 or joint.upper < 0
            zero = (joint.lower + joint.upper) / 2 if outside else 0.0
        state = {'min': joint.lower, 'max': joint.upper, 'zero': zero}
        if self.pub_def_positions:
            state['position'] = zero
        if self.pub_def_vels:
            state['velocity'] = 0.0
        if self.pub_def_efforts:
            state['effort'] = 0.0
        if joint.turns_on:
            state['continuous'] = True
        return state

    def robot_description_cb(self, msg: String) -> None:
        try:
            self.configure_robot(msg.data)
        except DescriptionError as error:
            self.get_logger().warning(f'robot_description: {error}')

    def set_robot_description_update_cb(self, user_cb: Callable[[], None]) -> None:
        """Have a function called after each new robot."""
        self.robot_description_update_cb = user_cb

    def set_source_update_cb(self, user_cb: Callable[[], None]) -> None:
        """Have a function called after each message of a source."""
        self.source_update_cb = user_cb

    def source_cb(self, msg: JointState) -> None:
        """Take over what a source says of joints that follow none."""
        for quantity in _QUANTITIES:
            for name, value in zip(msg.name, getattr(msg, quantity), strict=False):
                if name in self.free_joints:
                    self.free_joints[name][quantity] = value
        if self.source_update_cb is not None:
            self.source_update_cb()

    def timer_callback(self) -> None:
        """Publish all joints; nothing where there is none."""
        if self.delta > 0:
            self.update(self.delta)
        if not self.joint_list:
            return
        message = JointState(name=self.joint_list)
        message.header.stamp = self.get_clock().now().to_msg()
        for quantity in _QUANTITIES:
            known = any(quantity in state for state in self.free_joints.values())
            if known or (quantity == 'position' and self._followers):
                values = [self._value(name, quantity) for name in self.joint_list]
                setattr(message, quantity, values)
        self.pub.publish(message)

    def _value(self, name: str, quantity: str) -> float:
        follower = self._followers.get(name, Follower(name, 1.0, 0.0))
        value = self.free_joints[follower.leader].get(quantity)
        if value is None:
            return 0.0
        if quantity == 'effort':
            return float(value)
        offset = follower.offset if quantity == 'position' else 0.0
        return float(value) * follower.factor + offset

    def update(self, delta: float) -> None:
        """Move each free joint by so much, to and fro between its limits, or on and on."""
        for joint in self.free_joints.values():
            if 'position' not in joint:
                continue
            forward = joint.get('forward', True)
            joint['position'] += delta if forward else -delta
            if joint['position'] <= joint['max'] if forward else joint['position'] >= joint['min']:
                continue
            if joint.get('continuous', False):
                joint['position'] = joint['min']
            else:
                joint['position'] = joint['max'] if forward else joint['min']
                joint['forward'] = not forward


def _number(parameter: Parameter) -> float:
    if isinstance(parameter.value, (int, float)):
        return parameter.value
    raise ValueError(f'{parameter.name}={parameter.value!r}: it has to be a number')


def _make(path: str | None) -> JointStatePublisher:
    try:
        return JointStatePublisher(path)
    except DescriptionError as error:
        raise DescriptionError(f'{path}: {error}') from None


def main() -> int:
    parser = argparse.ArgumentParser(prog='joint_state_publisher', description=__doc__)
    parser.add_argument(
        'description_file',
        nargs='?',
        help='URDF, SDF or COLLADA; without one it comes on the topic robot_description',
    )
    words = parser.parse_args(own_words(sys.argv))
    return run_node(lambda _: _make(words.description_file), sys.argv)


if __name__ == '__main__':
    sys.exit(main())
