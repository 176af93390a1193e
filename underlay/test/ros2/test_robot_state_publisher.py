# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""robot_state_publisher: the transforms of a robot's links, what it refuses and what it tells."""

from __future__ import annotations

from functools import partial
import math
from pathlib import Path
import signal
import subprocess
from typing import Any

from playpen_testing.here import run_here
from playpen_testing.spinning import SpunNodes
from playpen_testing.standard_error import standard_error
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from robot_state_publisher import node
from robot_state_publisher.node import RobotStatePublisher
from robot_state_publisher.urdf import read_joints, UrdfError
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from tf2_ros import Buffer, TransformListener

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ARM = """<?xml version='1.0'?>
<robot name='arm'>
  <link name='base'/> <link name='mast'/> <link name='boom'/> <link name='hand'/>
  <link name='tool'/> <link name='free'/>
  <joint name='stands' type='fixed'>
    <parent link='base'/> <child link='mast'/> <origin xyz='0 0 HEIGHT'/> <axis xyz='0 0 0'/>
  </joint>
  <joint name='turns' type='continuous'>
    <parent link='mast'/> <child link='boom'/> <origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/>
    <axis xyz='0 0 5'/>
  </joint>
  <joint name='slides' type='prismatic'>
    <parent link='boom'/> <child link='hand'/> <limit lower='0' upper='2' effort='1' velocity='1'/>
  </joint>
  <joint name='follows' type='revolute'>
    <parent link='hand'/> <child link='tool'/> <limit effort='1' velocity='1'/>
    <axis xyz='0 1 0'/> <mimic joint='turns' multiplier='-2' offset='0.5'/>
  </joint>
  <joint name='floats' type='floating'> <parent link='base'/> <child link='free'/> </joint>
</robot>"""


def turned(axis: int, angle: float) -> list[float]:
    """Return the quaternion of a turn about an axis, as `place` rounds it."""
    turn = [0.0, 0.0, 0.0, math.cos(0.5 * angle)]
    turn[axis] = math.sin(0.5 * angle)
    return [round(each, 6) for each in turn]


class Arm:
    """Runs robot_state_publisher; publishes positions of joints, and listens to the frames."""

    def __init__(self, nodes: SpunNodes, **parameters: Any) -> None:
        self.publisher = nodes.start(RobotStatePublisher, **parameters)
        self.node = nodes.start(Node, 'listener')
        states = self.node.create_publisher(JointState, 'joint_states', 10)
        self.send = states.publish
        self._buffer = Buffer()
        TransformListener(self._buffer, self.node)
        wait_until(states.get_subscription_count, timeout_sec=10.0, what='a listener')

    def publish(self, *, stamp_sec: float | None = None, **positions: float) -> None:
        message = JointState(name=[*positions], position=[*positions.values()])
        now = self.node.get_clock().now()
        message.header.stamp = (now if stamp_sec is None else Time(seconds=stamp_sec)).to_msg()
        self.send(message)

    def place(self, parent: str, child: str) -> list[float] | None:
        """Return where a frame is in another, rounded: x, y, z, and the quaternion."""
        if not self._buffer.can_transform(parent, child, Time()):
            return None
        found = self._buffer.lookup_transform(parent, child, Time()).transform
        to, turn = found.translation, found.rotation
        return [round(each, 6) for each in (to.x, to.y, to.z, turn.x, turn.y, turn.z, turn.w)]

    def until(self, place: list[float], parent: str, child: str, **positions: float) -> None:
        """Publish positions until a frame is there."""

        def there() -> bool:
            if positions:
                self.publish(**positions)
            return self.place(parent, child) == place

        wait_until(
            there,
            timeout_sec=15.0,
            what=lambda: f'{child} at {place}; it is at {self.place(parent, child)}',
        )


def test_links_are_where_the_joints_have_them(domain: int) -> None:
    text = ARM.replace('HEIGHT', '0.5')
    with SpunNodes(domain) as nodes:
        arm = Arm(nodes, robot_description=text, frame_prefix='left/')
        told: list[Any] = []
        arm.node.create_subscription(String, 'robot_description', told.append, LATCHED)
        arm.until([0.0, 0.0, 0.5, *turned(0, 0.0)], 'left/base', 'left/mast')
        at = [1.0, 0.0, 0.0, *turned(2, 0.5 * math.pi + 0.2)]
        arm.until(at, 'left/mast', 'left/boom', turns=0.2, slides=1.5, unknown=1.0)
        arm.until([1.5, 0.0, 0.0, *turned(0, 0.0)], 'left/boom', 'left/hand')
        arm.until([0.0, 0.0, 0.0, *turned(1, 0.5 - 2 * 0.2)], 'left/hand', 'left/tool')
        assert arm.place('left/base', 'left/free') is None, 'no joint says where it floats'
        wait_until(lambda: bool(told), timeout_sec=10.0, what='the description')
        assert told[0].data == text
        higher = text.replace('0 0 0.5', '0 0 0.75')
        (result,) = arm.publisher.set_parameters([Parameter('robot_description', value=higher)])
        assert result.successful
        arm.until([0.0, 0.0, 0.75, *turned(0, 0.0)], 'left/base', 'left/mast')
        wait_until(lambda: told[-1].data == higher, timeout_sec=10.0, what='the new description')
        for name, value, why in (
            ('robot_description', '<robot', 'robot_description: this is no XML'),
            ('publish_frequency', 1000.5, 'publish_frequency must be between 0 and 1000'),
        ):
            (result,) = arm.publisher.set_parameters([Parameter(name, value=value)])
            assert not result.successful
            assert result.reason.startswith(why)


def test_what_moves_no_link_is_told_once(domain: int) -> None:
    def heard(*texts: str) -> bool:
        arm.publish(elbow=1.0)
        arm.publish(stamp_sec=0.0, turns=0.3, slides=0.1)
        return all(text in logged() for text in texts)

    with standard_error() as logged, SpunNodes(domain) as nodes:
        arm = Arm(nodes, robot_description=ARM.replace('HEIGHT', '1'))
        wait_until(
            # In any order: the first of the first two may come before their readers are matched.
            partial(heard, "names 'elbow', which moves nothing here", 'set ignore_timestamp'),
            timeout_sec=10.0,
            what=lambda: f'words about the elbow and about stamps; what was told: {logged()}',
        )
        assert "joint_states names 'elbow', which moves nothing here" in logged()
        assert 'that move: follows, slides, turns' in logged()
        assert arm.place('mast', 'boom') is None
        arm.publisher.set_parameters([Parameter('ignore_timestamp', value=True)])
        at = [1.0, 0.0, 0.0, *turned(2, 0.5 * math.pi + 0.3)]
        wait_until(
            lambda: heard() and arm.place('mast', 'boom') == at,
            timeout_sec=10.0,
            what=lambda: f'the boom; it is at {arm.place("mast", "boom")}',
        )
        assert logged().count('[WARN]') == 2, logged()


def test_a_joint_that_is_never_named_is_told_once(
    domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def told() -> bool:
        arm.publish(turns=0.3, slids=0.1)
        return '[WARN]' in logged()

    monkeypatch.setattr(node, '_ALL_NAMED_WITHIN_NS', 10**18)
    with standard_error() as logged, SpunNodes(domain) as nodes:
        arm = Arm(nodes, robot_description=ARM.replace('HEIGHT', '1'), ignore_timestamp=True)
        at = [1.0, 0.0, 0.0, *turned(2, 0.5 * math.pi + 0.3)]
        arm.until(at, 'mast', 'boom', turns=0.3, slids=0.1)
        assert not told()
        monkeypatch.setattr(node, '_ALL_NAMED_WITHIN_NS', 0)
        wait_until(told, timeout_sec=10.0, what='words about the joint that slides')
        arm.until(at, 'mast', 'boom', turns=0.3, slids=0.1)
        assert logged().count('[WARN]') == 1, logged()
        assert (
            'joint_states has not named slides, so that there is no transform to hand; slids, '
            'which it names, moves nothing here\n'
        ) in logged()


def test_what_no_joint_can_have_ends_nothing(domain: int) -> None:
    def told() -> bool:
        arm.publish(turns=math.inf, slides=math.nan)
        old = JointState(name=['turns'], position=[0.1])
        old.header.stamp.sec = -1
        arm.send(old)
        return 'with a negative stamp is ignored' in logged()

    with standard_error() as logged, SpunNodes(domain) as nodes:
        arm = Arm(nodes, robot_description=ARM.replace('HEIGHT', '1'))
        wait_until(told, timeout_sec=10.0, what=lambda: f'a word about the stamp; {logged()}')
        at = [1.0, 0.0, 0.0, *turned(2, 0.5 * math.pi + 0.2)]
        arm.until(at, 'mast', 'boom', turns=0.2)


def test_a_rate_is_kept_by_the_stamps_until_time_goes_back(domain: int) -> None:
    with SpunNodes(domain) as nodes:
        arm = Arm(
            nodes,
            robot_description=ARM.replace('HEIGHT', '1'),
            publish_frequency=2.0,
            use_sim_time=True,
        )
        clock = arm.node.create_publisher(Clock, '/clock', 10)
        stamps_sec: list[float] = []
        arm.node.create_subscription(
            TFMessage,
            '/tf',
            lambda message: stamps_sec.append(
                Time.from_msg(message.transforms[0].header.stamp).nanoseconds * 1e-9
            ),
            10,
        )
        wait_until(
            lambda: arm.publisher.count_subscribers('/tf') == 2, timeout_sec=10.0, what='a reader'
        )

        def is_now(sec: int) -> bool:
            clock.publish(Clock(clock=Time(seconds=sec).to_msg()))
            return bool(arm.publisher.get_clock().now().nanoseconds == sec * 10**9)

        def until_published(*due_sec: float) -> None:
            wait_until(
                lambda: stamps_sec == [*due_sec],
                timeout_sec=10.0,
                what=lambda: f'transforms of {due_sec}; there are those of {stamps_sec}',
            )

        wait_until(partial(is_now, 20), timeout_sec=10.0, what='a time')
        for stamp_sec in (10.0, 10.4, 10.5):
            arm.publish(stamp_sec=stamp_sec, turns=0.1)
        until_published(10.0, 10.5)
        wait_until(partial(is_now, 5), timeout_sec=10.0, what='a time before')
        arm.publish(stamp_sec=1.0, turns=0.1)
        until_published(10.0, 10.5, 1.0)


@pytest.mark.parametrize('command', ['xacro', 'ros2 run xacro xacro'])
def test_a_launch_file_starts_it_and_ctrl_c_ends_it(
    domain: int, processes: Any, tmp_path: Path, command: str
) -> None:
    macros = "<robot xmlns:xacro='http://www.ros.org/wiki/xacro' name='arm'>"
    height = "<xacro:property name='height' value='2'/>"
    text = ARM.replace("<robot name='arm'>", macros + height).replace('HEIGHT', '${height}')
    (tmp_path / 'arm.urdf.xacro').write_text(text)
    launch = tmp_path / 'arm.launch.xml'
    launch.write_text(
        '<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">'
        '<param name="robot_description" type="str" '
        f'value="$(command \'{command} {tmp_path}/arm.urdf.xacro\')"/></node></launch>'
    )
    process = processes.ros2('launch', str(launch), ready='Robot initialized')
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert 'process has finished cleanly' in output


@pytest.mark.parametrize(
    ('arguments', 'why'),
    [
        ((), 'the parameter robot_description is empty; it has to be the text of a URDF'),
        (('/nowhere.urdf',), '/nowhere.urdf cannot be read: [Errno 2] No such file'),
        (
            ('--ros-args', '-p', 'robot_description:="<robot"'),
            'robot_description: this is no XML: unclosed token: line 1, column 0',
        ),
    ],
)
@pytest.mark.usefixtures('domain')
def test_without_a_urdf_it_ends_with_one_line(
    arguments: tuple[str, ...], why: str, capfd: pytest.CaptureFixture[str]
) -> None:
    ended = run_here(capfd, 'robot_state_publisher.node', *arguments)
    assert ended.status == 2
    assert why in ended.err
    assert 'Traceback' not in ended.err


@pytest.mark.usefixtures('domain')
def test_its_program_ends_with_that_line() -> None:
    command = ['ros2', 'run', 'robot_state_publisher', 'robot_state_publisher', '/nowhere.urdf']
    done = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert done.returncode == 2
    assert '/nowhere.urdf cannot be read: [Errno 2] No such file' in done.stderr
    assert 'Traceback' not in done.stderr


TWO = "<robot name='r'><link name='a'/><link name='b'/>{}</robot>"
JOINT = "<joint name='j' type='{}'><parent link='a'/><child link='b'/>{}</joint>"


@pytest.mark.parametrize(
    ('text', 'why'),
    [
        ('<model/>', 'the outermost element is <model>, expected is <robot>'),
        ('<robot/>', 'the robot: the attribute name is missing'),
        ("<robot name='r'/>", 'it has no link'),
        ("<robot name='r'><link/></robot>", 'a link: the attribute name is missing'),
        (
            "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>"
            "<xacro:property name='x' value='1'/></robot>",
            '<xacro:property> is no URDF: let the command xacro make one of it',
        ),
        (TWO.format(''), "'a' and 'b' are no children of a joint; one may be"),
        (TWO.format("<link name='a'/>"), "there are two links 'a'"),
        (TWO.format(2 * JOINT.format('fixed', '')), "there are two joints 'j'"),
        (
            TWO.format(
                JOINT.format('fixed', '') + JOINT.format('fixed', '').replace("'j'", "'k'")
            ),
            "link 'b' is the child of two joints",
        ),
        (
            TWO.format(
                JOINT.format('fixed', '')
                + "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>"
            ),
            "link 'a' is its own ancestor",
        ),
        (TWO.format(JOINT.format('fixed', '').replace("'b'", "'c'")), "there is no link 'c'"),
        (TWO.format("<joint name='j' type='fixed'/>"), '<parent> is missing'),
        (TWO.format(JOINT.format('hinge', '')), "the type 'hinge' is unknown; there are revolute"),
        (TWO.format(JOINT.format('revolute', '')), 'a revolute joint needs a <limit>'),
        (TWO.format(JOINT.format('fixed', "<origin xyz='1 2'/>")), 'has to be three numbers'),
        (TWO.format(JOINT.format('fixed', "<origin rpy='0 0 x'/>")), "'x' is no number"),
        (TWO.format(JOINT.format('fixed', "<origin xyz='0 0 nan'/>")), "'nan' is no number"),
        (TWO.format(JOINT.format('continuous', "<axis xyz='0 0 0'/>")), 'has no direction'),
    ],
)
def test_what_is_no_urdf_is_refused_in_one_line(text: str, why: str) -> None:
    with pytest.raises(UrdfError) as caught:
        read_joints(text)
    assert why in str(caught.value)
    assert '\n' not in str(caught.value)
