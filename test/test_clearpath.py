# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The interface of a real A200, beside that of the lab: names, types, QoS, frames, and a drive."""

from collections.abc import Callable
from functools import partial
import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import TwistStamped
from husky_course.record import read_record, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_driver.drive import Drive
from husky_driver.ros.node import FollowPath
from husky_grader.scoring import judge
from husky_sim.ros.node import SimulatorNode
from nav_msgs.msg import Odometry
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    qos_profile_sensor_data,
    QoSProfile,
    ReliabilityPolicy,
)
from sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan, NavSatFix
from std_msgs.msg import Bool, String
from tf2_msgs.msg import TFMessage

ROOT = Path(__file__).resolve().parent.parent
# The first lobe of an eight: it begins with a turn on the spot.
TURNING = 'speed: 0.6\nwaypoints: [[0, 0], [-0.5, 1.2], [-1.6, 1.2], [-3, 0]]\n'
# Of clearpath_control, as docs/real_husky.md has them.
LIMITS_OF_ROBOT: dict[str, Any] = {
    'acceleration_limit_m_s2': 1.0,
    'yaw_rate_limit_rad_s': 1.0,
    'yaw_acceleration_limit_rad_s2': 1.0,
    'command_timeout_sec': 0.5,
}
# Clearpath's Platform API and Sensors API for ROS 2 Jazzy, of what the simulator has.
PUBLISHED: dict[str, tuple[Any, str]] = {
    'platform/odom': (Odometry, 'base_link'),
    'platform/odom/filtered': (Odometry, 'base_link'),
    'platform/cmd_vel': (TwistStamped, ''),
    'platform/joint_states': (JointState, ''),
    'platform/emergency_stop': (Bool, ''),
    'platform/bms/state': (BatteryState, ''),
    'sensors/imu_0/data': (Imu, 'imu_0_link'),
    'sensors/lidar2d_0/scan': (LaserScan, 'lidar2d_0_laser'),
    'sensors/gps_0/fix': (NavSatFix, 'gps_0_link'),
}
SENSOR_DATA = ('sensors/imu_0/data', 'platform/emergency_stop', 'platform/bms/state')
NAMESPACE = '/a200_0000/'


class Station(Node):
    """A computer beside the robot: it hears all topics, and commands."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__('station', namespace=NAMESPACE.strip('/'), **arguments)
        topics = PUBLISHED | {'battery_state': (BatteryState, '')}  # the lab's own
        self.heard: dict[str, list[Any]] = {topic: [] for topic in topics}
        for topic, (kind, _) in topics.items():
            self.create_subscription(
                kind, topic, self.heard[topic].append, qos_profile_sensor_data
            )
        self.commands = self.create_publisher(TwistStamped, 'cmd_vel', 10)
        self.stops = self.create_publisher(Bool, 'e_stop', 10)

    def drive(self, speed_m_s: float, stamp_sec: int = 0, *, yaw_rate_rad_s: float = 0.0) -> None:
        message = TwistStamped()
        message.header.stamp.sec = stamp_sec
        message.twist.linear.x = speed_m_s
        message.twist.angular.z = yaw_rate_rad_s
        self.commands.publish(message)

    def latest(self, topic: str) -> Any:
        wait_until(lambda: bool(self.heard[topic]), timeout_sec=10.0, what=f'a message on {topic}')
        return self.heard[topic][-1]

    @property
    def speed_m_s(self) -> float:
        return float(self.latest('platform/odom').twist.twist.linear.x)


@pytest.fixture
def station(nodes: SpunNodes) -> Station:
    make = partial(SimulatorNode, namespace=NAMESPACE.strip('/'))
    nodes.start(make, interface='clearpath', lidar_rate_hz=10.0, battery=True)
    return nodes.start(Station)


def keep(
    station: Station, command: Callable[[], object], until: Callable[[], bool], what: str
) -> None:
    """Command until something is true: a robot that hears nothing stops."""

    def is_so() -> bool:
        command()
        return until()

    wait_until(is_so, timeout_sec=10.0, what=what)


def test_topics_have_the_names_types_qos_and_frames_of_the_robot(station: Station) -> None:
    for topic, (kind, frame) in PUBLISHED.items():
        message = station.latest(topic)
        (publisher,) = station.get_publishers_info_by_topic(NAMESPACE + topic)
        reliable = publisher.qos_profile.reliability == ReliabilityPolicy.RELIABLE
        assert (type(message), reliable) == (kind, topic not in SENSOR_DATA), topic
        child = getattr(message, 'child_frame_id', None)
        assert not frame or frame in (child, message.header.frame_id), topic
    assert station.latest('platform/joint_states').name[0] == 'front_left_wheel_joint'
    (taker,) = station.get_subscriptions_info_by_topic(f'{NAMESPACE}cmd_vel')
    assert taker.topic_type == 'geometry_msgs/msg/TwistStamped'


def test_the_description_has_the_frames_of_the_robot(station: Station) -> None:
    told: list[String] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    station.create_subscription(String, 'robot_description', told.append, latched)
    wait_until(lambda: bool(told), timeout_sec=10.0, what='robot_description')
    links = {link.get('name') for link in ElementTree.fromstring(told[-1].data).iter('link')}
    assert {frame for _, frame in PUBLISHED.values() if frame} <= links
    assert {'front_laser', 'camera_0_color_optical_frame'} <= links


def test_the_imu_feels_what_is_felt_where_its_frame_is(station: Station) -> None:
    told: list[TFMessage] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    station.create_subscription(TFMessage, 'tf_static', told.append, latched)
    wait_until(lambda: bool(told), timeout_sec=10.0, what='tf_static')
    ahead_m = {each.child_frame_id: each.transform.translation.x for each in told[0].transforms}
    seen = station.heard['sensors/imu_0/data']
    keep(
        station,
        lambda: station.drive(0.0, yaw_rate_rad_s=1.5),
        lambda: len(seen) > 50 and all(each.angular_velocity.z > 1.4 for each in seen[-25:]),
        'half a second of turning on the spot',
    )
    turning = seen[-25:]
    felt_m_s2 = sum(each.linear_acceleration.x for each in turning) / len(turning)
    # In a turn on the spot, what is ahead of the middle is drawn outwards.
    outwards_m_s2 = -(turning[-1].angular_velocity.z ** 2) * ahead_m['imu_0_link']
    assert felt_m_s2 == pytest.approx(outwards_m_s2, abs=0.05)


def test_the_battery_is_told_as_the_robot_tells_it(station: Station) -> None:
    def by_stamp_ns(topic: str) -> dict[int, BatteryState]:
        stamped = [(each.header.stamp, each) for each in station.heard[topic]]
        return {stamp.sec * 10**9 + stamp.nanosec: each for stamp, each in stamped}

    def told_on_both() -> list[int]:
        ours, of_robot = by_stamp_ns('battery_state'), by_stamp_ns('platform/bms/state')
        return sorted(ours.keys() & of_robot.keys())

    wait_until(lambda: len(told_on_both()) > 1, timeout_sec=10.0, what='two states on both topics')
    last_ns = told_on_both()[-1]
    assert all(stamp_ns % 240_000_000 == 0 for stamp_ns in told_on_both())
    for topic in ('battery_state', 'platform/bms/state'):
        state = by_stamp_ns(topic)[last_ns]
        assert 25.0 < state.voltage < 25.4
        assert state.current == pytest.approx(60.0 / state.voltage, rel=0.01), 'it is not negative'
        assert 0.9 < state.percentage < 1.0
        assert state.charge == pytest.approx(20.0 * state.percentage)
        assert (state.capacity, state.design_capacity, state.present) == (20.0, 20.0, True)
        assert state.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        assert state.power_supply_health == BatteryState.POWER_SUPPLY_HEALTH_GOOD
        assert state.power_supply_technology == BatteryState.POWER_SUPPLY_TECHNOLOGY_UNKNOWN
        assert list(state.cell_voltage) == [state.voltage / 2.0] * 2
        assert all(map(math.isnan, (state.temperature, *state.cell_temperature)))


def test_an_empty_battery_is_explained_once(
    nodes: SpunNodes, capfd: pytest.CaptureFixture[str]
) -> None:
    nodes.start(SimulatorNode, battery=True, battery_charge=0.00001)
    listener = nodes.start(partial(Node, 'listener'))
    heard: list[DiagnosticStatus] = []
    listener.create_subscription(
        DiagnosticArray, '/diagnostics', lambda message: heard.extend(message.status[1:]), 10
    )
    wait_until(
        lambda: bool(heard) and 'empty' in heard[-1].message,
        timeout_sec=10.0,
        what='an empty battery',
    )
    (line,) = [line for line in capfd.readouterr().err.splitlines() if 'battery' in line]
    assert line.endswith(
        'husky: the battery is empty, so that the motors are off; reset the simulation, or start '
        'it with a greater battery_charge'
    )
    status = heard[-1]
    assert (status.name, status.level) == ('husky_sim: battery of husky', DiagnosticStatus.ERROR)
    assert status.message == '23.2 V, 0 % charged; empty: the motors are off until a reset'


def test_the_page_on_the_robot_names_every_topic() -> None:
    page = (ROOT / 'docs' / 'real_husky.md').read_text()
    assert [topic for topic in (*PUBLISHED, 'cmd_vel') if f'`{topic}`' not in page] == []


def test_a_stamped_command_drives_unless_it_is_old(station: Station) -> None:
    without_stamp = partial(station.drive, 0.5)
    keep(station, without_stamp, lambda: station.speed_m_s > 0.45, 'a robot that drives')
    wait_until(lambda: abs(station.speed_m_s) < 1e-3, timeout_sec=10.0, what='a robot that stands')
    now_sec = station.latest('platform/odom').header.stamp.sec
    wait_until(
        lambda: station.latest('platform/odom').header.stamp.sec > now_sec + 1,
        timeout_sec=10.0,
        what='a time long after the stamp of the next command',
    )
    heard = len(station.heard['platform/cmd_vel'])
    keep(
        station,
        lambda: station.drive(0.5, stamp_sec=max(now_sec, 1)),
        lambda: len(station.heard['platform/cmd_vel']) > heard + 25,
        'half a second of old commands',
    )
    since = station.heard['platform/cmd_vel'][heard:]
    assert {each.twist.linear.x for each in since} == {0.0}


def test_the_emergency_stop_is_told_and_holds(station: Station) -> None:
    assert not station.latest('platform/emergency_stop').data
    pressed = Bool(data=True)
    keep(
        station,
        lambda: station.stops.publish(pressed),
        lambda: bool(station.latest('platform/emergency_stop').data),
        'an emergency stop',
    )
    heard = len(station.heard['platform/odom'])
    keep(
        station,
        lambda: station.drive(0.5),
        lambda: len(station.heard['platform/odom']) > heard + 25,
        'half a second of commands',
    )
    assert abs(station.speed_m_s) < 1e-3


def test_follow_path_drives_a_robot_with_the_limits_of_a_real_one(
    nodes: SpunNodes, tmp_path: Path
) -> None:
    record, course = tmp_path / 'run.record', tmp_path / 'turning.yaml'
    course.write_text(TURNING)
    route = plan_route(load_course(course))
    nodes.start(
        partial(SimulatorNode, namespace='a200_0000'),
        interface='clearpath',
        record=str(record),
        lockstep=True,
        real_time_factor=0.0,
        **LIMITS_OF_ROBOT,
    )
    driver = nodes.start(
        partial(FollowPath, namespace='a200_0000'),
        lambda settings, _: Drive(route, limits=settings.drive_limits),
        progress='off',
        interface='clearpath',
        limits='a200',
    )
    wait_until(driver.finished.done, timeout_sec=60.0, what='the end of the drive')
    assert driver.finished.result() == 0
    assert judge(read_run(read_record(record)), route).cross_track_max_m < 0.05


def test_follow_path_drives_the_same_by_either_interface(
    nodes: SpunNodes, tmp_path: Path, short_course: Path
) -> None:
    trajectories = set()
    for interface in ('lab', 'clearpath'):
        record = tmp_path / f'{interface}.csv'
        simulator = nodes.start(
            partial(SimulatorNode, namespace='a200_0000'),
            interface=interface,
            record=str(record),
            lockstep=True,
            real_time_factor=0.0,
        )
        driver = nodes.start(
            partial(FollowPath, namespace='a200_0000'),
            lambda *_: Drive(plan_route(load_course(short_course))),
            progress='off',
            interface=interface,
        )
        wait_until(driver.finished.done, timeout_sec=60.0, what=f'the end by {interface}')
        assert driver.finished.result() == 0
        nodes.close(driver)
        nodes.close(simulator)
        trajectories.add(read_run(read_record(record)).trajectory_sha256)
    assert len(trajectories) == 1
