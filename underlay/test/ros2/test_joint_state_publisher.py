# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""joint_state_publisher: where it has the joints of robots, what it refuses, how it ends."""

from __future__ import annotations

import math
from pathlib import Path
import signal
import subprocess
from typing import Any

from husky_sim.world import default_worlds, urdf_of
from joint_state_publisher.description import DescriptionError, read_joints
from joint_state_publisher.joint_state_publisher import JointStatePublisher
from joint_state_publisher.mimics import Follower, followers
from playpen_testing.spinning import SpunNodes
from playpen_testing.standard_error import standard_error
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from robot_state_publisher.node import RobotStatePublisher
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_ros import Buffer, TransformListener

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LIMIT = "<limit lower='{}' upper='{}' effort='1' velocity='1'/>"
ARM = f"""<?xml version='1.0'?>
<robot name='arm'>
  <joint name='stands' type='fixed'/>
  <joint name='turns' type='continuous'/>
  <joint name='slides' type='prismatic'>{LIMIT.format(1, 2)}
    <safety_controller soft_lower_limit='1.5' soft_upper_limit='9'/></joint>
  <joint name='follows' type='revolute'>{LIMIT.format(-1, 1)}
    <mimic joint='turns' multiplier='-2' offset='0.5'/></joint>
  <joint name='follows too' type='revolute'>{LIMIT.format(-1, 1)}
    <mimic joint='follows' multiplier='3'/></joint>
  <joint name='grips' type='revolute'>{LIMIT.format(-1, 1)}</joint>
  <joint name='floats' type='floating'/> <joint name='lies' type='planar'/>
</robot>"""
ALL = ['turns', 'slides', 'follows', 'follows too', 'grips']


class Listener:
    """A node beside the publisher: it describes robots, is a source, and hears what comes out."""

    def __init__(self, nodes: SpunNodes) -> None:
        self.heard: list[JointState] = []
        self.node = nodes.start(Node, 'listener')
        self.node.create_subscription(JointState, 'joint_states', self.heard.append, 10)
        self._descriptions = self.node.create_publisher(String, 'robot_description', LATCHED)
        self._sources = self.node.create_publisher(JointState, 'measured', 10)

    def describe(self, text: str) -> None:
        self._descriptions.publish(String(data=text))

    def measure(self, publisher: JointStatePublisher, message: JointState) -> None:
        (source,) = publisher.sources
        wait_until(
            lambda: self._sources.get_subscription_count() == source.get_publisher_count() == 1,
            timeout_sec=10.0,
            what='a source',
        )
        self._sources.publish(message)

    def until(self, quantity: str, **expected: float) -> JointState:
        """Wait for a message with these values, and return it."""

        def newest() -> dict[str, float]:
            message = self.heard[-1] if self.heard else JointState()
            return dict(zip(message.name, getattr(message, quantity), strict=False))

        wait_until(
            lambda: newest() == {**newest(), **expected},
            timeout_sec=10.0,
            what=lambda: f'{quantity} {expected}; it is {newest()}',
        )
        return self.heard[-1]


def test_the_husky_has_all_its_frames(domain: int) -> None:
    text = urdf_of(default_worlds() / 'husky.xml')
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'listener')
        buffer = Buffer()
        TransformListener(buffer, node)
        nodes.start(RobotStatePublisher, robot_description=text)
        angle = 0.5
        parameters: dict[str, Any] = {'zeros.front_left_wheel_joint': angle, 'rate': 50.0}
        publisher = nodes.start(JointStatePublisher, **parameters)
        wheels = [f'{end}_{side}' for end in ('front', 'rear') for side in ('left', 'right')]
        wait_until(
            lambda: all(
                buffer.can_transform('base_link', f'{wheel}_wheel_link', Time())
                for wheel in wheels
            ),
            timeout_sec=10.0,
            what=lambda: f'all wheels; there are the frames {buffer.all_frames_as_yaml()}',
        )
        turn = buffer.lookup_transform('base_link', 'front_left_wheel_link', Time())
        assert turn.transform.rotation.y == pytest.approx(math.sin(0.5 * angle))
        assert len(publisher.joint_list) == 4


def test_joints_are_where_description_parameters_and_sources_have_them(domain: int) -> None:
    parameters: dict[str, Any] = {
        'zeros.turns': 0.1,
        'dependent_joints.grips.parent': 'slides',
        'dependent_joints.grips.factor': 2,
        'dependent_joints.nobody.parent': 'slides',
        'publish_default_velocities': True,
        'source_list': ['measured'],
        'rate': 100,
    }
    with standard_error() as logged, SpunNodes(domain) as nodes:
        listener = Listener(nodes)
        publisher = nodes.start(JointStatePublisher, **parameters)
        updated: list[str] = []
        publisher.set_robot_description_update_cb(lambda: updated.append('robot'))
        publisher.set_source_update_cb(lambda: updated.append('source'))
        listener.describe(ARM)
        at_zero = {'slides': 1.75, 'grips': 3.5, 'turns': 0.1}
        first = listener.until('position', **at_zero, follows=0.3)
        assert first.name == ALL
        assert first.position[3] == pytest.approx(0.9)
        assert (first.velocity.tolist(), first.effort.tolist()) == ([0.0] * 5, [])
        assert Time.from_msg(first.header.stamp).nanoseconds > 0
        listener.measure(
            publisher,
            JointState(name=['turns', 'grips', 'x'], position=[1.0], velocity=[2.0, 9.0, 9.0]),
        )
        listener.until('position', turns=1.0, follows=-1.5, slides=1.75)
        moving = {'turns': 2.0, 'follows': -4.0, 'follows too': -12.0}
        listener.until('velocity', **moving, grips=0.0)
        listener.measure(publisher, JointState(name=['slides'], effort=[5.0]))
        listener.until('effort', slides=5.0, grips=5.0, turns=0.0)
        assert updated == ['robot', 'source', 'source']
        listener.describe('<robot')
        wait_until(
            lambda: 'robot_description: this is no XML' in logged(),
            timeout_sec=10.0,
            what=lambda: f'a warning; what was told: {logged()}',
        )
        assert publisher.joint_list == ALL, 'the robot before stays'


def test_without_mimic_tags_and_soft_limits_joints_are_free(domain: int, tmp_path: Path) -> None:
    (tmp_path / 'arm.urdf').write_text(ARM)
    parameters: dict[str, Any] = {
        **dict.fromkeys(('use_mimic_tags', 'use_smallest_joint_limits'), False),
        'publish_default_positions': False,
        'publish_default_efforts': True,
    }
    with SpunNodes(domain) as nodes:
        publisher = nodes.start(JointStatePublisher, tmp_path / 'arm.urdf', **parameters)
        assert list(publisher.free_joints) == ALL
        expected = {'min': 1.0, 'max': 2.0, 'zero': 1.5, 'effort': 0.0}
        assert publisher.free_joints['slides'] == expected
        assert publisher.dependent_joints == {}
        publisher.update(0.1)
        assert publisher.free_joints['slides'] == expected, 'without position nothing moves'


def test_joints_move_to_and_fro_and_on_and_on(domain: int, tmp_path: Path) -> None:
    (tmp_path / 'arm.urdf').write_text(ARM)
    with SpunNodes(domain) as nodes:
        publisher = nodes.start(JointStatePublisher, tmp_path / 'arm.urdf', rate=0.001, delta=0.2)
        way = []
        for _ in range(5):
            publisher.update(publisher.delta)
            way.append(round(publisher.free_joints['slides']['position'], 6))
        assert way == [1.95, 2.0, 1.8, 1.6, 1.5]
        publisher.update(3.0)
        assert publisher.free_joints['turns']['position'] == -math.pi


def test_the_program_publishes_until_ctrl_c(domain: int, processes: Any, tmp_path: Path) -> None:
    (tmp_path / 'arm.urdf').write_text(ARM)
    with SpunNodes(domain) as nodes:
        listener = Listener(nodes)
        program = ('run', 'joint_state_publisher', 'joint_state_publisher')
        process = processes.ros2(*program, str(tmp_path / 'arm.urdf'), ready='Got description')
        listener.until('position', turns=0.0, slides=1.75)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=10)
        assert process.returncode == 0, output
        assert 'Traceback' not in output


CIRCLE = ARM.replace(
    "'turns' type='continuous'/>", "'turns' type='continuous'><mimic joint='follows'/></joint>"
)


@pytest.mark.parametrize(
    ('text', 'status', 'lines'),
    [
        (ARM.replace("lower='1'", ''), 2, ['"lower" limit must be specified for joint "slides"']),
        (CIRCLE, 1, ['Got description', "Found an infinite recursive mimic chain: ['turns', "]),
    ],
    ids=['bad', 'circle'],
)
@pytest.mark.usefixtures('domain')
def test_a_bad_robot_ends_the_program_with_one_line(
    text: str, status: int, lines: list[str], tmp_path: Path
) -> None:
    (tmp_path / 'arm.urdf').write_text(text)
    command = ['ros2', 'run', 'joint_state_publisher', 'joint_state_publisher', 'arm.urdf']
    done = subprocess.run(command, capture_output=True, text=True, timeout=30)
    told = [line for line in done.stderr.splitlines() if not line.startswith('[ros2run]')]
    assert done.returncode == status
    assert len(told) == len(lines), done.stderr
    for line, expected in zip(told, lines, strict=True):
        assert expected in line


@pytest.mark.parametrize(
    ('parameters', 'why'),
    [
        ({'rate': 0}, 'rate=0: it has to be above 0, in Hz'),
        ({'delta': 'fast'}, "delta='fast': it has to be a number"),
        ({'source_list': 'measured'}, "source_list='measured': it has to be a list of topics"),
        ({'dependent_joints.a.factor': 1.0}, 'dependent_joints.a: a parent is missing'),
        ({'dependent_joints.a.angle': 1.0}, "Invalid dependent_joint name 'a.angle'"),
    ],
)
def test_a_wrong_parameter_is_refused(domain: int, parameters: dict[str, Any], why: str) -> None:
    with SpunNodes(domain) as nodes, pytest.raises(ValueError, match=why):
        nodes.start(JointStatePublisher, **parameters)


SDF = """<sdf version='1.8'><model name='m'><joint name='j' type='{}'><axis>{}</axis></joint>
</model></sdf>"""
COLLADA = """<COLLADA xmlns='http://www.collada.org/2008/03/COLLADASchema' version='{}'>
<kinematics_model><technique_common><joint name='j'><revolute><limits>{}</limits></revolute>
</joint></technique_common></kinematics_model></COLLADA>"""
DEGREES = '<min>-90</min><max>{}</max>'
TURNS = '<limit><lower>-1</lower><upper>{}</upper></limit>'


def test_limits_of_sdf_and_collada_are_read() -> None:
    (joint,) = read_joints(SDF.format('revolute', TURNS.format(2)))
    assert (joint.name, joint.lower, joint.upper, joint.turns_on) == ('j', -1.0, 2.0, False)
    (joint,) = read_joints(SDF.format('continuous', ''))
    assert (joint.lower, joint.upper, joint.turns_on) == (-math.pi, math.pi, True)
    assert read_joints(SDF.format('ball', '')) == []
    (joint,) = read_joints(COLLADA.format('1.5.0', DEGREES.format(180)))
    assert [joint.lower, joint.upper] == pytest.approx([-math.pi / 2, math.pi])
    assert read_joints(COLLADA.format('1.5', DEGREES.format(-90))) == []


REVOLUTE = "<robot><joint name='j' type='revolute'>{}</joint></robot>"


@pytest.mark.parametrize(
    ('text', 'why'),
    [
        ('', 'this is no XML: no element found'),
        ('<model/>', 'URDF must have a "robot" tag'),
        ('<sdf/>', 'SDF must have a "model" tag'),
        ('<COLLADA/>', 'COLLADA must have a version tag'),
        ("<COLLADA version='1.4.1'/>", 'COLLADA must be at least version 1.5.0'),
        ("<COLLADA version='new'/>", '"new" is no version of COLLADA'),
        ("<COLLADA version='1.10'/>", 'COLLADA must have a "kinematics_model" tag'),
        (REVOLUTE.format(''), 'Limits must be specified for joint "j" of type "revolute"'),
        (REVOLUTE.format(LIMIT.format('a', 1)), '"lower" limit must be a float for joint "j"'),
        (
            REVOLUTE.format(LIMIT.format(0, 1) + "<mimic joint='k' offset='a'/>"),
            '"offset" must be a float for joint "j", not "a"',
        ),
        (SDF.format('revolute', '<limit/>'), '"lower" limit must be specified for joint "j"'),
        (SDF.format('revolute', TURNS.format('')), '"upper" limit must be a float for joint "j"'),
        (COLLADA.format('1.5.0', '<max>1</max>'), '"min" limit must be specified for joint "j"'),
        (
            "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:if/></robot>",
            '<xacro:if> is no URDF: let the command xacro make one of it',
        ),
    ],
)
def test_what_describes_no_robot_is_refused_in_one_line(text: str, why: str) -> None:
    with pytest.raises(DescriptionError) as caught:
        read_joints(text)
    assert str(caught.value).startswith(why)
    assert '\n' not in str(caught.value)


def test_who_follows_a_joint_that_stands_is_told_so() -> None:
    mimics = {'a': {'parent': 'b', 'factor': 2.0}, 'b': {'parent': 'c', 'offset': 1.0}}
    assert followers(mimics, ['c'])['a'] == Follower('c', 2.0, 2.0)
    with pytest.raises(
        DescriptionError, match='joint "b" mimics "c", which is no joint of the ro'
    ):
        followers(mimics, ['d'])
