# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Filters of real topics: sensors brought together in threads, the tutorials, silent topics."""

from __future__ import annotations

from collections.abc import Iterator
import threading
from typing import Any

from builtin_interfaces.msg import Time as TimeMsg
from message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    Chain,
    silence,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)
from message_filters.delta_filter import DeltaFilter
from message_filters.input_aligner import InputAligner
from nav_msgs.msg import Odometry
from playpen_testing.spinning import SpunNodes
from playpen_testing.standard_error import standard_error
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data, QoSProfile
from rclpy.task import Future
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, FluidPressure, Image, LaserScan, Temperature
from std_msgs.msg import Header, String

TEN = QoSProfile(depth=10)


@pytest.fixture
def nodes(domain: int) -> Iterator[SpunNodes]:
    with SpunNodes(domain) as spun:
        yield spun


def stamped(milliseconds: int) -> Header:
    return Header(stamp=Time(nanoseconds=milliseconds * 1_000_000).to_msg())


def milliseconds_of(stamp: TimeMsg) -> int:
    return int(Time.from_msg(stamp).nanoseconds // 1_000_000)


class Robot(Node):
    """Publishes what a robot publishes: a scan each 100 ms, odometry each 20, an image each 50."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('robot', **arguments)
        self.scan = self.create_publisher(LaserScan, 'front/scan', qos_profile_sensor_data)
        self.odometry = self.create_publisher(Odometry, 'odometry/filtered', 10)
        self.image = self.create_publisher(Image, 'camera/image_raw', 10)
        self.info = self.create_publisher(CameraInfo, 'camera/camera_info', 10)

    def wait_for_subscriptions(self, *publishers: Any) -> None:
        for publisher in publishers:
            wait_until(
                lambda publisher=publisher: publisher.get_subscription_count() > 0,  # type: ignore[misc]
                timeout_sec=10.0,
                what=f'a subscription of {publisher.topic_name}',
            )


class Follower(Node):
    """Brings scans and odometry together in a group of its own, and images with their cameras."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('follower', **arguments)
        self.group = group = ReentrantCallbackGroup()
        self.inputs = [
            Subscriber(
                self,
                LaserScan,
                'front/scan',
                qos_profile=qos_profile_sensor_data,
                callback_group=group,
            ),
            Subscriber(self, Odometry, 'odometry/filtered', 10, callback_group=group),
        ]
        self.near = ApproximateTimeSynchronizer(self.inputs, queue_size=10, slop=0.015)
        self.near.registerCallback(self.on_scan_and_odometry)
        cameras = [
            Subscriber(self, Image, 'camera/image_raw'),
            Subscriber(self, CameraInfo, 'camera/camera_info'),
        ]
        self.exact = TimeSynchronizer(cameras, 10)
        self.exact.registerCallback(self.on_image, 'front camera')
        self.pairs: list[tuple[int, int]] = []
        self.images: list[tuple[int, int, str]] = []

    def on_scan_and_odometry(self, scan: LaserScan, odometry: Odometry) -> None:
        self.pairs.append(
            (milliseconds_of(scan.header.stamp), milliseconds_of(odometry.header.stamp))
        )

    def on_image(self, image: Image, info: CameraInfo, camera: str) -> None:
        self.images.append((milliseconds_of(image.header.stamp), info.width, camera))


@pytest.fixture
def follower(domain: int) -> Iterator[Follower]:
    """Return a node that several threads serve."""
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = Follower(context=context)
    executor = MultiThreadedExecutor(4, context=context)
    executor.add_node(node)
    done: Future[None] = Future()
    thread = threading.Thread(target=executor.spin_until_future_complete, args=[done])
    thread.start()
    yield node
    done.set_result(None)
    executor.wake()
    thread.join(10.0)
    assert not thread.is_alive()
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()


def test_sensors_are_brought_together_in_threads(nodes: SpunNodes, follower: Follower) -> None:
    robot = nodes.start(Robot)
    robot.wait_for_subscriptions(robot.scan, robot.odometry, robot.image, robot.info)
    wait_until(
        lambda: follower.inputs[0].get_publisher_count() == 1,
        timeout_sec=10.0,
        what='the publisher of front/scan, which sends nothing twice',
    )
    for tenth in range(1, 11):
        robot.scan.publish(LaserScan(header=stamped(100 * tenth)))
        for t in range(100 * tenth - 47, 100 * tenth + 53, 20):
            robot.odometry.publish(Odometry(header=stamped(t)))
        robot.image.publish(Image(header=stamped(100 * tenth)))
        robot.info.publish(CameraInfo(header=stamped(100 * tenth + tenth % 2), width=tenth))
        expected = {
            (100 * t, odometry) for t in range(1, tenth + 1) for odometry in _near(100 * t)
        }
        wait_until(
            lambda tenth=tenth: len(follower.pairs) == tenth,  # type: ignore[misc]
            timeout_sec=10.0,
            what=lambda: f'one pair for each scan, not {follower.pairs}',
        )
        assert set(follower.pairs) <= expected
    wait_until(lambda: len(follower.images) == 5, timeout_sec=10.0, what='five images')
    assert follower.images == [(100 * t, t, 'front camera') for t in (2, 4, 6, 8, 10)]
    assert follower.inputs[0].getTopic() == 'front/scan'
    assert follower.inputs[0].topic_name == '/front/scan'  # asked of the subscription
    assert follower.inputs[0].callback_group is follower.group


def _near(scan: int) -> list[int]:
    """Return the stamps of odometry that may belong to a scan: whichever came first."""
    return [t for t in range(scan - 47, scan + 53, 20) if abs(t - scan) < 15]


class TimeSync(Node):
    """Is the node of upstream's two tutorials of synchronizers, with quicker timers."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('sync_node', **arguments)
        self.temp_pub = self.create_publisher(Temperature, 'temp', TEN)
        self.fluid_pub = self.create_publisher(FluidPressure, 'fluid', TEN)
        self.temp_sub = Subscriber(self, Temperature, 'temp')
        self.fluid_sub = Subscriber(self, FluidPressure, 'fluid')
        inputs = [self.temp_sub, self.fluid_sub]
        self.exact = TimeSynchronizer(inputs, 10)
        self.exact.registerCallback(self.on_equal)
        self.near = ApproximateTimeSynchronizer(inputs, 10, 0.05)
        self.near.registerCallback(self.on_near)
        self.equal = self.close = 0
        self.timer = self.create_timer(0.05, self.on_timer)

    def on_timer(self) -> None:
        now = Clock().now().to_msg()
        self.temp_pub.publish(Temperature(header=Header(stamp=now, frame_id='test')))
        self.fluid_pub.publish(FluidPressure(header=Header(stamp=now, frame_id='test')))

    def on_equal(self, temp: Temperature, fluid: FluidPressure) -> None:
        assert temp.header.stamp == fluid.header.stamp
        self.equal += 1

    def on_near(self, temp: Temperature, fluid: FluidPressure) -> None:
        stamps = [Time.from_msg(each.header.stamp).nanoseconds for each in (temp, fluid)]
        assert abs(stamps[0] - stamps[1]) < 50_000_000
        self.close += 1


class Counter(SimpleFilter):
    """Counts messages, as the filters that the tutorials write."""

    def __init__(self) -> None:
        super().__init__()
        self.count = 0

    def add(self, message: Any) -> None:
        self.count += 1
        self.signalMessage(message)


class Filters(Node):
    """Has what upstream's tutorials of the other filters make, one after another."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('filters', **arguments)
        self.publisher = self.create_publisher(String, '/example/topic', TEN)
        self.subscriber = Subscriber(self, String, '/example/topic', qos_profile=TEN)
        self.cache = Cache(self.subscriber, cache_size=5, allow_headerless=True)
        self.counters = [Counter(), Counter()]
        self.chain = Chain(self.cache)
        for counter in self.counters:
            self.chain.addFilter(counter)
        self.changes = Counter()
        self.delta = DeltaFilter(field_getters=[lambda msg: msg.data], message_filter=self.chain)
        self.delta.registerCallback(self.changes.add)
        self.published = 0
        self.timer = self.create_timer(timer_period_sec=0.02, callback=self.on_timer)

    def on_timer(self) -> None:
        self.publisher.publish(String(data=f'count: {self.published // 2}'))
        self.published += 1


def test_nodes_of_the_tutorials_run(nodes: SpunNodes) -> None:
    sync, filters = nodes.start(TimeSync), nodes.start(Filters)
    wait_until(
        lambda: sync.equal > 2 and sync.close > 2 and filters.changes.count > 4,
        timeout_sec=10.0,
        what=lambda: f'sets and changes, not {sync.equal}, {sync.close}, {filters.changes.count}',
    )
    filters.timer.cancel()
    first, second = filters.counters
    wait_until(lambda: first.count == second.count, timeout_sec=5.0, what='the end of the chain')
    assert first.count > filters.changes.count
    oldest, newest = filters.cache.getOldestTime(), filters.cache.getLastestTime()
    assert oldest is not None
    assert newest is not None
    assert len(filters.cache.getInterval(oldest, newest)) == 5


def test_an_aligner_of_topics_sorts_them(nodes: SpunNodes) -> None:
    class Sorted(Node):
        """Aligns two topics by a timer."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__('sorted', **arguments)
            inputs = [
                Subscriber(self, Image, 'camera/image_raw'),
                Subscriber(self, CameraInfo, 'camera/camera_info'),
            ]
            self.stamps: list[int] = []
            self.aligner = InputAligner(Duration(seconds=1), inputs)
            for index in range(2):
                self.aligner.registerCallback(index, self.on_message)
                self.aligner.setInputPeriod(index, Duration(nanoseconds=2_000_000))
            self.aligner.setupDispatchTimer(self, Duration(nanoseconds=10_000_000))

        def on_message(self, message: Any) -> None:
            self.stamps.append(milliseconds_of(message.header.stamp))

    robot, aligned = nodes.start(Robot), nodes.start(Sorted)
    robot.wait_for_subscriptions(robot.image, robot.info)
    # An input is waited for once something has come of it.
    robot.image.publish(Image(header=stamped(0)))
    robot.info.publish(CameraInfo(header=stamped(0)))
    wait_until(lambda: aligned.stamps == [0, 0], timeout_sec=10.0, what='the first of each')
    for t in (1, 3, 5):
        robot.image.publish(Image(header=stamped(t)))
    for t in (2, 4, 6):
        robot.info.publish(CameraInfo(header=stamped(t)))
    wait_until(
        lambda: aligned.stamps == [0, 0, 1, 2, 3, 4, 5, 6],
        timeout_sec=10.0,
        what=lambda: f'all in order, not {aligned.stamps}',
    )


def test_a_topic_that_does_not_arrive_is_named(
    nodes: SpunNodes, ros2: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Deaf(Node):
        """Asks for more of the scan than its publisher offers."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__('deaf', **arguments)
            self.inputs = [
                Subscriber(self, LaserScan, 'front/scan', TEN),
                Subscriber(self, Odometry, 'odometry/filtered', TEN),
            ]
            self.sync = ApproximateTimeSynchronizer(self.inputs, 10, 0.1)

    monkeypatch.setattr(silence, 'SILENT_AFTER_SEC', 0.0)

    def is_said() -> bool:
        ours = '[deaf]: no callback yet: no message on front/scan in 0 s, while odometry/filtered'
        return ours in logged() and 'offering incompatible QoS' in logged()  # which rclpy says

    with standard_error() as logged:
        robot = nodes.start(Robot)
        nodes.start(Deaf)
        robot.wait_for_subscriptions(robot.odometry)
        robot.scan.publish(LaserScan(header=stamped(1)))
        robot.odometry.publish(Odometry(header=stamped(1)))
        wait_until(is_said, timeout_sec=10.0, what=lambda: f'the warning in {logged()}')
    told = ros2('doctor')
    assert '/front/scan: /robot offers BEST_EFFORT, but /deaf requests RELIABLE' in told.out
