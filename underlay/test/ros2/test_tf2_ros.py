# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms over real DDS: broadcasters, listeners, waiting, time that jumps, the simulator."""

from __future__ import annotations

from collections.abc import Iterator
import inspect
import subprocess
import sys
from threading import Event
import time
from typing import Any

from geometry_msgs.msg import PointStamped, TransformStamped
from playpen_testing.processes import find_line
from playpen_testing.spinning import do_in_thread_of, SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy
from rclpy.time import Time
from rosgraph_msgs.msg import Clock
import tf2_geometry_msgs
from tf2_msgs.srv import FrameGraph
import tf2_ros

LATEST = Time()


def transform(parent: str, child: str, x: float = 0.0, sec: int = 1) -> TransformStamped:
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp.sec = sec
    message.transform.translation.x = x
    return message


class Sender(Node):
    """Has a broadcaster of each kind."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('sender', **arguments)
        self.moving = tf2_ros.TransformBroadcaster(self)
        self.fixed = tf2_ros.StaticTransformBroadcaster(self)


class Hearer(Node):
    """Keeps what it hears in a buffer."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('hearer', **arguments)
        self.buffer = tf2_ros.Buffer(node=self)
        self.listener = tf2_ros.TransformListener(self.buffer, self)

    def x_of(self, target: str, source: str) -> float:
        found = self.buffer.lookup_transform(target, source, LATEST, Duration(seconds=10))
        return float(found.transform.translation.x)


@pytest.fixture
def nodes(domain: int) -> Iterator[SpunNodes]:
    with SpunNodes(domain) as spun:
        yield spun


def matched(sender: Sender) -> None:
    wait_until(
        lambda: sender.moving.pub_tf.get_subscription_count() > 0,
        timeout_sec=10.0,
        what='a subscription of /tf',
    )


def test_what_is_sent_can_be_looked_up_and_static_ones_also_later(nodes: SpunNodes) -> None:
    sender = nodes.start(Sender)
    sender.fixed.sendTransform(transform('base', 'laser', 0.5))
    sender.fixed.sendTransform((transform('base', 'imu', 0.25), transform('base', 'laser', 9.0)))
    hearer = nodes.start(Hearer)
    matched(sender)
    sender.moving.sendTransform([transform('odom', 'base', 2.0), transform('map', 'odom', 3.0)])
    assert hearer.x_of('map', 'laser') == 5.5  # of each child the first static one counts
    assert hearer.x_of('base', 'imu') == 0.25
    assert "broadcaster: 'default_authority'" in hearer.buffer.all_frames_as_yaml()
    durabilities = {
        topic: {info.qos_profile.durability for info in hearer.get_publishers_info_by_topic(topic)}
        for topic in ('/tf', '/tf_static')
    }
    assert durabilities['/tf'] == {DurabilityPolicy.VOLATILE}
    assert durabilities['/tf_static'] == {DurabilityPolicy.TRANSIENT_LOCAL}


def test_a_listener_hears_no_more_after_it_was_unregistered(nodes: SpunNodes) -> None:
    sender, hearer = nodes.start(Sender), nodes.start(Hearer)
    matched(sender)
    do_in_thread_of(hearer, hearer.listener.unregister)
    wait_until(
        lambda: sender.moving.pub_tf.get_subscription_count() == 0,
        timeout_sec=10.0,
        what='the end of the subscription',
    )


def test_to_wait_in_the_only_thread_of_the_node_is_in_vain(nodes: SpunNodes) -> None:
    may_ask, asks = Event(), Event()
    told: list[BaseException] = []

    class Waiting(Hearer):
        """Looks up in a timer, with a timeout, as students write it first."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__(**arguments)
            self.timer = self.create_timer(0.01, self.on_timer)

        def on_timer(self) -> None:
            if not may_ask.is_set():
                return
            self.timer.cancel()
            asks.set()
            try:
                self.buffer.lookup_transform('odom', 'base', LATEST, Duration(seconds=1))
            except tf2_ros.LookupException as error:
                told.append(error)

    sender, waiting = nodes.start(Sender), nodes.start(Waiting)
    matched(sender)
    may_ask.set()
    assert asks.wait(10.0)
    sender.moving.sendTransform(transform('odom', 'base', 1.0))
    wait_until(lambda: bool(told), timeout_sec=10.0, what='the end of the lookup')
    assert str(told[0]) == (
        '"odom" passed to lookupTransform argument target_frame does not exist. '
    )
    assert waiting.x_of('odom', 'base') == 1.0  # it is heard as soon as the callback is over


def test_a_listener_with_a_thread_lets_a_callback_wait(domain: int) -> None:
    program = """
import rclpy, tf2_ros
from rclpy.duration import Duration
from rclpy.time import Time
rclpy.init()
node = rclpy.create_node('hearer')
buffer = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer, node, spin_thread=True)
def on_timer():
    timer.cancel()
    found = buffer.lookup_transform('odom', 'base', Time(), Duration(seconds=10))
    print('found', found.transform.translation.x, flush=True)
asking = rclpy.create_node('asking')
timer = asking.create_timer(0.01, on_timer)
rclpy.spin(asking)
"""
    process = subprocess.Popen(
        [sys.executable, '-c', program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    with SpunNodes(domain) as nodes:
        nodes.start(Sender).fixed.sendTransform(transform('odom', 'base', 7.0))
        assert process.stdout is not None
        find_line(process.stdout, r'^found 7\.0$')
        begin = time.monotonic()
        process.send_signal(2)
        _, said = process.communicate(timeout=10)
    assert (said, time.monotonic() - begin < 2.0) == ('', True)


def test_to_await_a_transform_lets_the_node_hear_it(nodes: SpunNodes) -> None:
    told: list[float] = []

    class Awaiting(Hearer):
        """Awaits a transform in a timer of the same executor."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__(**arguments)
            self.timer = self.create_timer(0.01, self.on_timer)

        async def on_timer(self) -> None:
            self.timer.cancel()
            found = await self.buffer.lookup_transform_async('odom', 'base', LATEST)
            told.append(found.transform.translation.x)
            asked = ('base', LATEST, 'odom', LATEST, 'odom')
            back = await self.buffer.lookup_transform_full_async(*asked)
            told.append(back.transform.translation.x)

    sender = nodes.start(Sender)
    nodes.start(Awaiting)
    matched(sender)
    sender.moving.sendTransform(transform('odom', 'base', 4.0))
    wait_until(lambda: told == [4.0, -4.0], timeout_sec=10.0, what='both lookups')


def test_a_future_tells_the_transform_as_soon_as_it_is_there() -> None:
    buffer = tf2_ros.Buffer()
    future = buffer.wait_for_transform_async('odom', 'base', Time(seconds=2))
    buffer.set_transform(transform('odom', 'base', 1.0, sec=1), 'test')
    assert not future.done()
    buffer.set_transform(transform('odom', 'base', 3.0, sec=3), 'test')
    assert future.result().transform.translation.x == 2.0
    buffer.set_transform(transform('odom', 'base', 9.0, sec=4), 'test')
    assert future.result().transform.translation.x == 2.0
    at_once = buffer.wait_for_transform_async('odom', 'base', LATEST)
    assert at_once.result().transform.translation.x == 9.0


def test_time_that_jumps_back_clears_the_buffer(
    nodes: SpunNodes, capfd: pytest.CaptureFixture[str]
) -> None:
    sender, clock = nodes.start(Sender), nodes.start(Node, 'clock')
    publisher = clock.create_publisher(Clock, '/clock', 10)
    hearer = nodes.start(Hearer, use_sim_time=True)

    def tell(sec: int) -> None:
        message = Clock()
        message.clock.sec = sec

        def arrived() -> bool:
            publisher.publish(message)
            return bool(hearer.get_clock().now().nanoseconds == sec * 10**9)

        wait_until(arrived, timeout_sec=10.0, what=f'the time {sec}')

    tell(100)
    matched(sender)
    sender.fixed.sendTransform(transform('base', 'laser', 1.0))
    sender.moving.sendTransform(transform('odom', 'base', 1.0, sec=100))
    assert hearer.x_of('odom', 'laser') == 2.0
    assert 'jump' not in capfd.readouterr().err
    tell(5)
    wait_until(  # the clock has its new time before it calls
        lambda: not hearer.buffer.can_transform('odom', 'base', LATEST),
        timeout_sec=10.0,
        what='the end of what moved',
    )
    assert hearer.x_of('base', 'laser') == 1.0
    said = capfd.readouterr().err
    assert '[tf2_buffer]: Detected jump back in time. Clearing tf buffer.\n' in said


def test_a_buffer_with_a_node_tells_its_frames_by_a_service(nodes: SpunNodes) -> None:
    sender, hearer = nodes.start(Sender), nodes.start(Hearer)
    sender.fixed.sendTransform(transform('odom', 'base'))
    hearer.x_of('odom', 'base')
    client = sender.create_client(FrameGraph, 'tf2_frames')
    assert client.wait_for_service(10.0)
    answered = Event()
    future = client.call_async(FrameGraph.Request())
    future.add_done_callback(lambda _: answered.set())
    assert answered.wait(10.0)
    assert future.result().frame_yaml == hearer.buffer.all_frames_as_yaml()


def test_an_object_that_nobody_transforms_is_refused() -> None:
    buffer = tf2_ros.Buffer()
    with pytest.raises(tf2_ros.TypeException) as caught:
        buffer.transform(Clock(), 'odom')
    assert caught.value.errstr == f'Type {Clock} is not loaded or supported'


def test_what_a_package_registers_transforms_and_converts() -> None:
    class Spot(PointStamped):
        """A type of which only this test knows."""

    def move(spot: Any, by: TransformStamped) -> Any:
        moved = tf2_ros.Stamped(Spot(), by.header.stamp, by.header.frame_id)
        moved.point.x = spot.point.x + by.transform.translation.x
        return moved

    tf2_ros.TransformRegistration().add(Spot, move)
    tf2_ros.ConvertRegistration().add_to_msg(Spot, lambda spot: spot.point)
    tf2_ros.ConvertRegistration().add_from_msg(float, lambda point: point.x)
    buffer = tf2_ros.Buffer()
    for x, sec in ((1.0, 1), (3.0, 3)):
        buffer.set_transform(transform('odom', 'base', x, sec), 'test')
    spot = tf2_ros.Stamped(Spot(), Time(seconds=2).to_msg(), 'base')
    assert buffer.transform(spot, 'odom').point.x == 2.0
    assert buffer.transform(spot, 'odom', new_type=float) == 2.0
    assert buffer.transform_full(spot, 'base', Time(seconds=3), 'odom').point.x == -1.0
    assert tf2_ros.convert(spot, Spot) is not spot
    tf2_ros.ConvertRegistration().add_convert((Spot, float), lambda spot: 10.0 * spot.point.x)
    assert buffer.transform(spot, 'odom', new_type=float) == 20.0  # straight, not by a message


@pytest.mark.parametrize(
    ('of', 'arguments'),
    [
        (tf2_ros.Buffer, 'cache_time node'),
        (tf2_ros.TransformListener, 'buffer node spin_thread qos static_qos'),
        (tf2_ros.TransformBroadcaster, 'node qos'),
        (tf2_ros.StaticTransformBroadcaster, 'node qos'),
        (tf2_ros.BufferClient, 'node ns check_frequency timeout_padding'),
        (tf2_ros.Buffer.lookup_transform, 'self target_frame source_frame time timeout'),
        (
            tf2_ros.Buffer.lookup_transform_full,
            'self target_frame target_time source_frame source_time fixed_frame timeout',
        ),
        (
            tf2_ros.Buffer.can_transform,
            'self target_frame source_frame time timeout return_debug_tuple',
        ),
        (tf2_ros.Buffer.transform, 'self object_stamped target_frame timeout new_type'),
        (tf2_ros.Buffer.wait_for_transform_async, 'self target_frame source_frame time'),
    ],
)
def test_arguments_have_the_names_of_jazzy(of: Any, arguments: str) -> None:
    assert list(inspect.signature(of).parameters) == arguments.split()


def test_programs_find_the_names_that_modules_of_jazzy_hand_on() -> None:
    # As in the tutorial on robot_state_publisher, and in much that people have written.
    assert tf2_ros.TransformStamped is tf2_geometry_msgs.TransformStamped is TransformStamped
    assert tf2_ros.PointStamped is tf2_geometry_msgs.PointStamped is PointStamped
    assert (tf2_ros.Duration, tf2_ros.Time, tf2_ros.Node) == (Duration, Time, Node)
    assert tf2_ros.TFMessage().transforms == []


def test_the_laser_of_the_simulated_husky_is_found_in_odom(nodes: SpunNodes) -> None:
    hearer = nodes.start(Hearer)
    hearer.set_parameters([Parameter('use_sim_time', value=True)])
    simulator = subprocess.Popen(
        ['ros2', 'run', 'husky_sim', 'husky_sim'], stderr=subprocess.PIPE, text=True
    )
    try:
        found = hearer.buffer.lookup_transform('odom', 'front_laser', LATEST, Duration(seconds=30))
        base = hearer.buffer.lookup_transform(
            'odom', 'base_link', Time.from_msg(found.header.stamp)
        )
    finally:
        simulator.send_signal(2)
        simulator.communicate(timeout=10)
    laser, robot = found.transform.translation, base.transform.translation
    assert (laser.x - robot.x) ** 2 + (laser.y - robot.y) ** 2 == pytest.approx(0.337**2)
    assert laser.z - robot.z == pytest.approx(0.30795)
