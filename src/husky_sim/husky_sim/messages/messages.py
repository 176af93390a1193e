# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulator's states as ROS messages.

Each class keeps one message packed, and packs the numbers of a control period into it.
"""

import math

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
import numpy as np
import numpy.typing as npt
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import (
    BatteryState,
    Imu,
    JointState,
    LaserScan,
    NavSatFix,
    NavSatStatus,
)
from std_msgs.msg import Bool

from husky_sim.messages.packed_message import PackedMessage
from husky_sim.robot.battery import BATTERIES, CAPACITY_AH
from husky_sim.robot.contacts import Collision
from husky_sim.robot.diff_drive import WheelOdometry
from husky_sim.robot.husky import JOINTS, Quaternion, Vector
from husky_sim.sensors import lidar
from husky_sim.sensors.battery_monitor import BatteryReading
from husky_sim.sensors.imu import VARIANCE as IMU_VARIANCE
from husky_sim.sensors.localization import PlanarFilter
from husky_sim.sensors.navsat import VARIANCE_M2
from husky_sim.simulation import SimulatedRobot

Stamp = tuple[int, int]
"""Simulated time: seconds, nanoseconds."""


# Diagonals of the velocity controller (husky_control, control.yaml).
ODOMETRY_VARIANCES = (0.001, 0.001, 0.001, 0.001, 0.001, 0.03)


def time_message(stamp: Stamp) -> Time:
    """Return a time as a message."""
    return Time(sec=stamp[0], nanosec=stamp[1])


class OdometryMessage(PackedMessage):
    """An odometry message of base_link."""

    def __init__(
        self, frame_id: str = 'odom', variances: tuple[float, ...] = ODOMETRY_VARIANCES
    ) -> None:
        message = Odometry(child_frame_id='base_link')
        message.header.frame_id = frame_id
        message.pose.covariance[::7] = variances
        message.twist.covariance[::7] = variances
        super().__init__(message)
        self.pack_stamp = self.packer(self.places['header']['stamp'])
        self.pack_pose = self.packer(self.places['pose']['pose'])
        self.pack_twist = self.packer(self.places['twist']['twist'])

    def pack_planar(self, estimate: WheelOdometry | PlanarFilter) -> None:
        """Pack an estimate that lives in the plane."""
        half = estimate.yaw / 2.0
        self.pack_pose(estimate.x, estimate.y, 0.0, 0.0, 0.0, math.sin(half), math.cos(half))
        self.pack_twist(estimate.speed_m_s, 0.0, 0.0, 0.0, 0.0, estimate.yaw_rate_rad_s)


class WheelOdometryMessage(OdometryMessage):
    """The pose from the wheels."""

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the wheel odometry."""
        self.pack_stamp(*stamp)
        self.pack_planar(robot.odometry)


class FilteredOdometryMessage(OdometryMessage):
    """The filtered pose, with its covariance."""

    def __init__(self) -> None:
        super().__init__()
        self._pose_covariance = self.numbers(self.places['pose']['covariance'])
        self._twist_covariance = self.numbers(self.places['twist']['covariance'])

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the estimate; the covariances are of x, y, yaw, and of their speeds."""
        self.pack_stamp(*stamp)
        self.pack_planar(robot.filtered)
        _copy_plane(robot.filtered.pose_covariance, self._pose_covariance)
        _copy_plane(robot.filtered.twist_covariance, self._twist_covariance)


class GroundTruthMessage(OdometryMessage):
    """Where the robot is."""

    def __init__(self) -> None:
        super().__init__('world', (0.0,) * 6)

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the true pose and twist."""
        state = robot.state
        self.pack_stamp(*stamp)
        self.pack_pose(*state.position, *_xyzw(state.orientation))
        self.pack_twist(*state.velocity, *state.angular_velocity)


class ImuMessage(PackedMessage):
    """An IMU message with the variances of its noise, whether that is on or not."""

    def __init__(self, frame_id: str = 'base_link') -> None:
        message = Imu()
        message.header.frame_id = frame_id
        message.orientation_covariance[::4] = IMU_VARIANCE
        message.angular_velocity_covariance[::4] = IMU_VARIANCE
        message.linear_acceleration_covariance[::4] = IMU_VARIANCE
        super().__init__(message)
        self._stamp = self.packer(self.places['header']['stamp'])
        self._orientation = self.packer(self.places['orientation'])
        self._rate = self.packer(self.places['angular_velocity'])
        self._acceleration = self.packer(self.places['linear_acceleration'])

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack what the IMU measures."""
        sample = robot.imu
        self._stamp(*stamp)
        self._orientation(*_xyzw(sample.orientation))
        self._rate(*sample.angular_velocity)
        self._acceleration(*sample.acceleration)


class JointStateMessage(PackedMessage):
    """A message of the four wheels."""

    def __init__(self) -> None:
        zeros = [0.0] * len(JOINTS)
        super().__init__(
            JointState(name=list(JOINTS), position=zeros, velocity=zeros, effort=zeros)
        )
        self._stamp = self.packer(self.places['header']['stamp'])
        self._angles = self.packer(self.places['position'])
        self._speeds = self.packer(self.places['velocity'])
        self._torques = self.packer(self.places['effort'])

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the wheels."""
        wheels = robot.wheels
        self._stamp(*stamp)
        self._angles(*wheels.angles_rad)
        self._speeds(*wheels.speeds_rad_s)
        self._torques(*wheels.torques_n_m)


class CommandMessage(PackedMessage):
    """A velocity command."""

    def __init__(self) -> None:
        super().__init__(Twist())
        self._twist = self.packer(self.places)

    def pack(self, _: Stamp, robot: SimulatedRobot) -> None:
        """Pack the command as the limits left it."""
        controller = robot.controller
        self._twist(controller.speed_m_s, 0.0, 0.0, 0.0, 0.0, controller.yaw_rate_rad_s)


class StampedCommandMessage(PackedMessage):
    """A velocity command with its time."""

    def __init__(self) -> None:
        message = TwistStamped()
        message.header.frame_id = 'base_link'
        super().__init__(message)
        self._stamp = self.packer(self.places['header']['stamp'])
        self._twist = self.packer(self.places['twist'])

    def pack(self, stamp: Stamp, robot: SimulatedRobot) -> None:
        """Pack the command as the limits left it."""
        controller = robot.controller
        self._stamp(*stamp)
        self._twist(controller.speed_m_s, 0.0, 0.0, 0.0, 0.0, controller.yaw_rate_rad_s)


class EmergencyStopMessage(PackedMessage):
    """Whether the emergency stop is pressed."""

    def __init__(self) -> None:
        super().__init__(Bool())
        self._data = self.packer(self.places)

    def pack(self, _: Stamp, robot: SimulatedRobot) -> None:
        """Pack the state."""
        self._data(robot.is_stopped)


class ScanMessage(PackedMessage):
    """A scan of the laser."""

    def __init__(self, frame_id: str = lidar.FRAME, *, rate_hz: float = 10.0) -> None:
        message = LaserScan(
            angle_min=-lidar.HALF_ANGLE_RAD,
            angle_max=lidar.HALF_ANGLE_RAD,
            angle_increment=lidar.ANGLE_INCREMENT_RAD,
            scan_time=1.0 / rate_hz,
            range_min=lidar.RANGE_MIN_M,
            range_max=lidar.RANGE_MAX_M,
            ranges=[0.0] * lidar.BEAMS,
        )
        message.header.frame_id = frame_id
        super().__init__(message)
        self._stamp = self.packer(self.places['header']['stamp'])
        self._ranges = self.array(self.places['ranges'])

    def pack(self, stamp: Stamp, ranges: npt.NDArray[np.float32]) -> None:
        """Pack the range of every beam, in m."""
        self._stamp(*stamp)
        self._ranges[:] = ranges


class FixMessage(PackedMessage):
    """A fix of the satellite receiver, with the variances of its noise."""

    def __init__(self, frame_id: str = 'base_link') -> None:
        message = NavSatFix(position_covariance_type=NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN)
        message.header.frame_id = frame_id
        message.status.status = NavSatStatus.STATUS_FIX
        message.status.service = NavSatStatus.SERVICE_GPS
        message.position_covariance[::4] = VARIANCE_M2
        super().__init__(message)
        self._stamp = self.packer(self.places['header']['stamp'])
        degrees_and_m = ('latitude', 'longitude', 'altitude')
        self._place = self.packer(*(self.places[name] for name in degrees_and_m))

    def pack(self, stamp: Stamp, fix: Vector) -> None:
        """Pack latitude and longitude in degrees, altitude in metres."""
        self._stamp(*stamp)
        self._place(*fix)


class BatteryMessage(PackedMessage):
    """A message of the battery, with the fields that clearpath_robot fills in for an A200."""

    def __init__(self) -> None:
        message = BatteryState(
            temperature=math.nan,
            capacity=CAPACITY_AH,
            design_capacity=CAPACITY_AH,
            power_supply_status=BatteryState.POWER_SUPPLY_STATUS_DISCHARGING,
            power_supply_health=BatteryState.POWER_SUPPLY_HEALTH_GOOD,
            power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_UNKNOWN,
            present=True,
            cell_voltage=[0.0] * BATTERIES,
            cell_temperature=[math.nan] * BATTERIES,
        )
        super().__init__(message)
        self._stamp = self.packer(self.places['header']['stamp'])
        names = ('voltage', 'current', 'charge', 'percentage')
        self._values = [self.packer(self.places[name]) for name in names]
        self._batteries = self.packer(self.places['cell_voltage'])

    def pack(self, stamp: Stamp, reading: BatteryReading) -> None:
        """Pack a measurement."""
        self._stamp(*stamp)
        charge_ah = reading.charge * CAPACITY_AH
        values = (reading.voltage_v, reading.current_a, charge_ah, reading.charge)
        for pack, value in zip(self._values, values, strict=True):
            pack(value)
        self._batteries(*[reading.voltage_v / BATTERIES] * BATTERIES)


class ClockMessage(PackedMessage):
    """The simulated time."""

    def __init__(self) -> None:
        super().__init__(Clock())
        self._stamp = self.packer(self.places)

    def pack(self, stamp: Stamp) -> None:
        """Pack the time."""
        self._stamp(*stamp)


def new_collision(touch: Collision) -> DiagnosticStatus:
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


def _copy_plane(estimate: 'memoryview[float]', packed: 'memoryview[float]') -> None:
    """Copy the covariances of x, y and yaw, from the filter's eight a row to a message's six."""
    packed[0], packed[1], packed[5] = estimate[0], estimate[1], estimate[2]
    packed[6], packed[7], packed[11] = estimate[8], estimate[9], estimate[10]
    packed[30], packed[31], packed[35] = estimate[16], estimate[17], estimate[18]


def _xyzw(orientation: Quaternion) -> tuple[float, float, float, float]:
    """Order a quaternion as messages do."""
    w, x, y, z = orientation
    return x, y, z, w
