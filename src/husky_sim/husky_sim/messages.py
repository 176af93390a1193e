# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulator's states as ROS messages.

Each function fills a message that was made once: what never changes is already in it, since
building a message costs more than the physics between two of them.
"""

import math
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState

from husky_sim.contacts import Touch
from husky_sim.diff_drive import VelocityController, WheelOdometry
from husky_sim.husky import JOINTS, Quaternion, RobotState, Vector
from husky_sim.imu import VARIANCE as IMU_VARIANCE
from husky_sim.localization import PlanarFilter
from husky_sim.simulation import SimulatedRobot

# Diagonals of the velocity controller (husky_control, control.yaml).
ODOMETRY_VARIANCES = (0.001, 0.001, 0.001, 0.001, 0.001, 0.03)


# Where x, y and yaw stand in the 6 x 6 covariances of a message.
_PLANE = [0, 1, 5, 6, 7, 11, 30, 31, 35]


def new_imu() -> Imu:
    """Make an IMU message with the variances of its noise, whether that is on or not."""
    message = Imu()
    message.header.frame_id = 'base_link'
    for covariance in (
        message.orientation_covariance,
        message.angular_velocity_covariance,
        message.linear_acceleration_covariance,
    ):
        covariance[::4] = IMU_VARIANCE
    return message


def new_joint_state() -> JointState:
    """Make a message of the four wheels."""
    message = JointState()
    message.name = list(JOINTS)
    return message


class OdometryMessage:
    """An odometry message of base_link, with its parts at hand."""

    def __init__(self, frame_id: str, variances: tuple[float, ...]) -> None:
        self.message = Odometry()
        self.message.header.frame_id = frame_id
        self.message.child_frame_id = 'base_link'
        for place, variance in enumerate(variances):
            self.message.pose.covariance[7 * place] = variance
            self.message.twist.covariance[7 * place] = variance
        self._position = self.message.pose.pose.position
        self._orientation = self.message.pose.pose.orientation
        self._linear = self.message.twist.twist.linear
        self._angular = self.message.twist.twist.angular

    def fill_planar(self, estimate: WheelOdometry | PlanarFilter) -> None:
        """Fill in an estimate that lives in the plane."""
        self._position.x, self._position.y = estimate.x, estimate.y
        self._orientation.z = math.sin(estimate.yaw / 2.0)
        self._orientation.w = math.cos(estimate.yaw / 2.0)
        self._linear.x = estimate.speed_m_s
        self._angular.z = estimate.yaw_rate_rad_s

    def fill_covariance(self, estimate: PlanarFilter) -> None:
        """Fill in how sure the filter is: of x, y, yaw, and of their speeds in base_link."""
        covariance = estimate.covariance
        self.message.pose.covariance[_PLANE] = covariance[:3, :3].ravel()
        self.message.twist.covariance[_PLANE] = covariance[3:6, 3:6].ravel()

    def fill_truth(self, state: RobotState) -> None:
        """Fill in the true pose and twist."""
        _set_xyz(self._position, state.position)
        _set_quaternion(self._orientation, state.orientation)
        _set_xyz(self._linear, state.velocity)
        _set_xyz(self._angular, state.angular_velocity)


def fill_imu(message: Imu, robot: SimulatedRobot) -> None:
    """Fill in what the IMU measures."""
    _set_quaternion(message.orientation, robot.imu.orientation)
    _set_xyz(message.angular_velocity, robot.imu.angular_velocity)
    _set_xyz(message.linear_acceleration, robot.imu.acceleration)


def fill_joint_state(message: JointState, robot: SimulatedRobot) -> None:
    """Fill in the wheels."""
    message.position = robot.wheels.angles_rad
    message.velocity = robot.wheels.speeds_rad_s
    message.effort = robot.wheels.torques_n_m


def fill_command(message: Twist, controller: VelocityController) -> None:
    """Fill in the command as the limits left it."""
    message.linear.x = controller.speed_m_s
    message.angular.z = controller.yaw_rate_rad_s


def new_collision(touch: Touch) -> DiagnosticStatus:
    """Make the message of a collision."""
    x, y, z = touch.position
    return DiagnosticStatus(
        level=DiagnosticStatus.ERROR,
        name=touch.obstacle,
        message=f'{touch.robot} touched {touch.obstacle} with its {touch.part}',
        hardware_id=touch.robot,
        values=[
            KeyValue(key='obstacle', value=touch.obstacle),
            KeyValue(key='part', value=touch.part),
            KeyValue(key='force_n', value=f'{touch.force_n:.1f}'),
            KeyValue(key='position', value=f'{x:.3f} {y:.3f} {z:.3f}'),
            KeyValue(key='time_sec', value=f'{touch.time_sec:.3f}'),
        ],
    )


def _set_xyz(message: Any, values: Vector) -> None:
    message.x, message.y, message.z = values


def _set_quaternion(message: Any, values: Quaternion) -> None:
    message.w, message.x, message.y, message.z = values
