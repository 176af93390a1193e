# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages compared with the state of the physics: by name, in the right frame."""

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from husky_course.robot import RobotStart
from husky_sim.messages import messages
from husky_sim.robot.contacts import Collision
from husky_sim.sensors.battery_monitor import BatteryReading
from husky_sim.sensors.navsat import VARIANCE_M2
from husky_sim.simulation import Simulation
import mujoco
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import BatteryState, Imu, JointState, LaserScan, NavSatFix
from std_msgs.msg import Bool

from husky_sim.config import SimulationConfig

Drive = Callable[..., None]
STAMP = (2_000_000_000, 987_654_321)


@pytest.fixture
def simulation(worlds: Path, drive: Drive) -> Simulation:
    """Drive a curve, from a start that is turned and away from the origin."""
    start = RobotStart(x=2.0, y=-1.0, yaw=2.0)
    driven = Simulation(SimulationConfig(world=str(worlds / 'empty.xml'), robots=(start,)))
    drive(driven, 0.6, 0.7, seconds=2.0)
    return driven


def stamp_of(message: Any) -> tuple[int, int]:
    return message.header.stamp.sec, message.header.stamp.nanosec


def pose_of(message: Odometry) -> list[float]:
    position, turn = message.pose.pose.position, message.pose.pose.orientation
    return [position.x, position.y, position.z, turn.w, turn.x, turn.y, turn.z]


def twist_of(message: Odometry) -> list[float]:
    linear, angular = message.twist.twist.linear, message.twist.twist.angular
    return [angular.x, angular.y, angular.z, linear.x, linear.y, linear.z]


def true_twist(simulation: Simulation) -> list[float]:
    """Return rates and velocity of base_link, in base_link, as MuJoCo has them."""
    twist = np.zeros(6)
    body = simulation.model.body('husky/base_link').id
    mujoco.mj_forward(simulation.model, simulation.data)
    mujoco.mj_objectVelocity(
        simulation.model, simulation.data, mujoco.mjtObj.mjOBJ_XBODY, body, twist, 1
    )
    return [float(value) for value in twist]


def test_ground_truth_is_pose_and_twist_of_the_body(simulation: Simulation) -> None:
    packed = messages.GroundTruthMessage()
    packed.pack(STAMP, simulation.robots[0])
    message = deserialize_message(bytes(packed), Odometry)
    assert (stamp_of(message), message.header.frame_id) == (STAMP, 'world')
    assert not any([*message.pose.covariance, *message.twist.covariance])
    twist = true_twist(simulation)  # brings the body's pose up to date
    body = simulation.data.body('husky/base_link')
    assert pose_of(message) == pytest.approx([*body.xpos, *body.xquat], abs=1e-9)
    assert twist_of(message) == pytest.approx(twist, abs=1e-9)
    assert twist[3] == pytest.approx(0.6, rel=0.05)


def test_joint_states_are_those_of_the_joints_of_that_name(simulation: Simulation) -> None:
    packed = messages.JointStateMessage()
    packed.pack(STAMP, simulation.robots[0])
    message = deserialize_message(bytes(packed), JointState)
    assert stamp_of(message) == STAMP
    for name, angle, speed, torque in zip(
        message.name, message.position, message.velocity, message.effort, strict=True
    ):
        joint = simulation.data.joint(f'husky/{name}')
        assert (angle, speed) == (joint.qpos[0], joint.qvel[0])
        actuator = f'husky/{name.removesuffix("_joint")}'
        assert torque == simulation.data.actuator(actuator).force[0] != 0.0


def test_without_noise_the_imu_says_what_the_physics_holds(simulation: Simulation) -> None:
    packed = messages.ImuMessage()
    packed.pack(STAMP, simulation.robots[0])
    message = deserialize_message(bytes(packed), Imu)
    assert (stamp_of(message), message.header.frame_id) == (STAMP, 'base_link')
    turn, rate = message.orientation, message.angular_velocity
    twist = true_twist(simulation)
    body = simulation.data.body('husky/base_link')
    assert [turn.w, turn.x, turn.y, turn.z] == pytest.approx(body.xquat.tolist(), abs=1e-9)
    assert [rate.x, rate.y, rate.z] == pytest.approx(twist[:3], abs=1e-9)
    # On a circle nothing but gravity and the circle itself is felt.
    felt = message.linear_acceleration
    assert [felt.x, felt.y, felt.z] == pytest.approx([0.0, twist[2] * twist[3], 9.8], abs=0.05)
    for covariance in (
        message.orientation_covariance,
        message.angular_velocity_covariance,
        message.linear_acceleration_covariance,
    ):
        assert list(covariance[::4]) == [2.5e-5] * 3


def test_odometry_starts_at_its_own_origin_in_base_link(
    simulation: Simulation,
) -> None:
    robot = simulation.robots[0]
    filtered = messages.FilteredOdometryMessage()
    filtered.pack(STAMP, robot)
    message = deserialize_message(bytes(filtered), Odometry)
    assert stamp_of(message) == STAMP
    assert (message.header.frame_id, message.child_frame_id) == ('odom', 'base_link')
    x, y, _ = robot.state.position
    cos, sin = math.cos(2.0), math.sin(2.0)
    travelled = [cos * (x - 2.0) + sin * (y + 1.0), cos * (y + 1.0) - sin * (x - 2.0)]
    assert pose_of(message)[:2] == pytest.approx(travelled, abs=0.05)
    turned = 2.0 * math.atan2(message.pose.pose.orientation.z, message.pose.pose.orientation.w)
    assert math.remainder(turned - (robot.state.yaw - 2.0), math.tau) == pytest.approx(0, abs=0.01)
    assert twist_of(message) == pytest.approx(true_twist(simulation), abs=0.05)
    covariance = np.array(message.pose.covariance).reshape(6, 6)
    assert (covariance[np.ix_([0, 1, 5], [0, 1, 5])] == robot.filtered.covariance[:3, :3]).all()
    assert (np.diag(covariance) > 0.0).all()
    covariance = np.array(message.twist.covariance).reshape(6, 6)
    assert (covariance[np.ix_([0, 1, 5], [0, 1, 5])] == robot.filtered.covariance[3:6, 3:6]).all()


def test_the_command_out_is_what_the_limits_left(worlds: Path, drive: Drive) -> None:
    simulation = Simulation(SimulationConfig(world=str(worlds / 'empty.xml')))
    drive(simulation, 5.0, -9.0, seconds=0.02)
    packed = messages.CommandMessage()
    packed.pack(STAMP, simulation.robots[0])
    message = deserialize_message(bytes(packed), Twist)
    sent = [message.linear.x, message.linear.y, message.linear.z]
    assert sent == pytest.approx([0.06, 0.0, 0.0])
    sent = [message.angular.x, message.angular.y, message.angular.z]
    assert sent == pytest.approx([0.0, 0.0, -0.12])
    stamped = messages.StampedCommandMessage()
    stamped.pack(STAMP, simulation.robots[0])
    header = deserialize_message(bytes(stamped), TwistStamped)
    assert (stamp_of(header), header.header.frame_id) == (STAMP, 'base_link')
    assert header.twist == message


def test_wheel_odometry_is_that_of_the_controller(simulation: Simulation) -> None:
    robot, packed = simulation.robots[0], messages.WheelOdometryMessage()
    packed.pack(STAMP, robot)
    message = deserialize_message(bytes(packed), Odometry)
    assert (stamp_of(message), message.header.frame_id) == (STAMP, 'odom')
    odometry = robot.odometry
    half = odometry.yaw / 2.0
    flat = [odometry.x, odometry.y, 0.0, math.cos(half), 0.0, 0.0, math.sin(half)]
    assert pose_of(message) == flat
    assert twist_of(message) == [0.0, 0.0, odometry.yaw_rate_rad_s, odometry.speed_m_s, 0.0, 0.0]
    for covariance in (message.pose.covariance, message.twist.covariance):
        assert (covariance.reshape(6, 6) == np.diag([0.001] * 5 + [0.03])).all()


def test_clock_and_emergency_stop_tell_one_thing(worlds: Path) -> None:
    clock, stop = messages.ClockMessage(), messages.EmergencyStopMessage()
    clock.pack(STAMP)
    assert deserialize_message(bytes(clock), Clock).clock == messages.time_message(STAMP)
    assert (messages.time_message(STAMP).sec, messages.time_message(STAMP).nanosec) == STAMP
    robot = Simulation(SimulationConfig(world=str(worlds / 'empty.xml'))).robots[0]
    for pressed in (True, False):
        robot.is_stopped = pressed
        stop.pack(STAMP, robot)
        assert deserialize_message(bytes(stop), Bool).data is pressed


def test_a_battery_tells_what_was_measured_and_leaves_out_the_rest() -> None:
    packed = messages.BatteryMessage()
    packed.pack(STAMP, BatteryReading(voltage_v=25.5, current_a=-3.25, charge=0.75))
    message = deserialize_message(bytes(packed), BatteryState)
    assert stamp_of(message) == STAMP
    assert (message.voltage, message.current, message.percentage) == (25.5, -3.25, 0.75)
    assert (message.capacity, message.design_capacity, message.charge) == (20.0, 20.0, 15.0)
    assert list(message.cell_voltage) == [12.75, 12.75]
    assert [math.isnan(value) for value in message.cell_temperature] == [True, True]
    assert math.isnan(message.temperature)
    assert message.present
    assert message.power_supply_status == message.POWER_SUPPLY_STATUS_DISCHARGING
    assert message.power_supply_health == message.POWER_SUPPLY_HEALTH_GOOD
    assert message.power_supply_technology == message.POWER_SUPPLY_TECHNOLOGY_UNKNOWN


def test_a_collision_names_both_and_says_where_and_how_hard() -> None:
    touch = Collision(
        robot='a',
        obstacle='hydrant',
        part='front_bumper',
        time_sec=3.0625,
        force_n=17.26,
        position=(1.0, -2.5, 0.125),
    )
    message = messages.new_collision(touch)
    assert (message.level, message.name, message.hardware_id) == (b'\x02', 'hydrant', 'a')
    assert message.message == 'a touched hydrant with its front_bumper'
    assert {each.key: each.value for each in message.values} == {
        'obstacle': 'hydrant',
        'part': 'front_bumper',
        'force_n': '17.3',
        'position': '1.000 -2.500 0.125',
        'time_sec': '3.062',
    }


def test_scan_and_fix_describe_themselves() -> None:
    beamed, packed = messages.ScanMessage(), messages.FixMessage()
    measured = np.linspace(1.0, 30.0, 720, dtype=np.float32)
    measured[:2] = (-math.inf, math.inf)
    beamed.pack(STAMP, measured)
    scan = deserialize_message(bytes(beamed), LaserScan)
    packed.pack(STAMP, (49.5, 8.5, 12.0))
    fix = deserialize_message(bytes(packed), NavSatFix)
    assert (stamp_of(scan), scan.header.frame_id) == (STAMP, 'front_laser')
    assert list(scan.ranges) == measured.tolist()
    assert not scan.intensities
    assert (scan.range_min, scan.range_max) == pytest.approx((0.1, 30.0))
    beams = 1 + round((scan.angle_max - scan.angle_min) / scan.angle_increment)
    assert beams == 720
    assert scan.scan_time == pytest.approx(0.1)
    assert (stamp_of(fix), fix.header.frame_id) == (STAMP, 'base_link')
    assert (fix.latitude, fix.longitude, fix.altitude) == (49.5, 8.5, 12.0)
    assert list(fix.position_covariance[::4]) == [VARIANCE_M2] * 3
    assert (fix.status.status, fix.status.service) == (0, 1)  # a fix, by GPS
    assert fix.position_covariance_type == fix.COVARIANCE_TYPE_DIAGONAL_KNOWN
