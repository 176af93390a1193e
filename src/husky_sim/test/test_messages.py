# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages compared with the state of the physics: by name, in the right frame."""

from collections.abc import Callable
import math
from pathlib import Path
from typing import Any

from geometry_msgs.msg import Twist
from husky_course.robot import RobotStart
from husky_sim.messages import messages
from husky_sim.sensors.navsat import VARIANCE_M2
from husky_sim.simulation import Simulation
import mujoco
from nav_msgs.msg import Odometry
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Imu, JointState, LaserScan, NavSatFix

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
    assert (message.linear.x, message.angular.z) == pytest.approx((0.06, -0.12))


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
    assert fix.position_covariance_type == fix.COVARIANCE_TYPE_DIAGONAL_KNOWN
