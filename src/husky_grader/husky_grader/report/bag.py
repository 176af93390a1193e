# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A run as ROS 2 messages in one file, for Lichtblick, Foxglove and `ros2 bag`.

The topics have the names and the times that they had in the run, and hold what the record holds:
the motion in the plane, without wheels, heights and covariances. front/scan is worked out from it,
whether the laser was on or not. The others are for those who look at it: cross_track_error is that
of the report, tf_static tells where odom stands in world, and because Lichtblick draws no
odometry, the robot and its whole ways are there as markers and paths.
"""

from collections.abc import Iterator, Sequence
from functools import partial
import math
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, Twist
from husky_course.files import replacing
from husky_course.frames import Array
from husky_course.record import Record, RecordRefused
from husky_course.robot import RobotStart
from husky_course.route import Route
from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.errors import SimulatorError
from husky_sim.messages import (
    fixed_transforms,
    new_collision,
    new_transform,
    OdometryMessage,
    PackedMessage,
    ScanMessage,
    TFMessage,
)
from husky_sim.recording import RecordedScans, SCAN_RATE_HZ
from nav_msgs.msg import Odometry
from nav_msgs.msg import Path as PathMessage
import numpy as np
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64
from visualization_msgs.msg import MarkerArray

from husky_grader.report.files import BAG
from husky_grader.report.markers import RobotMarkers, surroundings
from husky_grader.report.mcap_file import Topic, write_mcap
from husky_grader.scoring.report import Report

EVERY = 5  # of the samples of a path, 2 cm apart
_UNKNOWN = (0.0,) * 6  # as covariances

Messages = Iterator[tuple[int, bytes]]


def write_bag(folder: Path, record: Record, place: int, route: Route, report: Report) -> str:
    """
    Write the run of one robot; return why it, or its scans, cannot be written, or nothing.

    :param place: which robot of the record.
    """
    topics, lacking = _topics(record, place, route, report), ''
    try:
        scans = RecordedScans(record, place)
    except (SimulatorError, RecordRefused) as error:
        lacking = f'{folder / BAG}: without front/scan: {error}'
    else:
        name = f'{_space(record, place)}front/scan'
        topics.append(Topic(name, LaserScan, _scans(record, scans)))
    try:
        with replacing(folder / BAG) as part:
            write_mcap(part, topics)
    except OSError as error:
        return f'{folder / BAG}: cannot be written: {error.strerror}; the report is there'
    return lacking


def _space(record: Record, place: int) -> str:
    return f'/{record.robots[place].name}/' if len(record.robots) > 1 else '/'


def _scans(record: Record, scans: RecordedScans) -> Messages:
    message = ScanMessage(rate_hz=SCAN_RATE_HZ)
    for row, ranges in scans:
        time_ns = _ns(record.time_sec[row])
        message.pack(_stamp(time_ns), ranges)
        yield time_ns, bytes(message)


def _topics(record: Record, place: int, route: Route, report: Report) -> list[Topic]:
    start = record.robots[place]
    space = _space(record, place)
    motion = _Motion(record, place)
    first_ns = motion.times_ns[0]
    touches = [touch for touch in record.collisions if touch.robot == start.name]
    collisions = [(_ns(touch.time_sec), _bytes(new_collision(touch))) for touch in touches]
    still: dict[str, Any] = {
        'path': _path('odom', route.curve.x, route.curve.y),
        'odometry/path': _path('odom', *motion.columns('odom_x', 'odom_y')),
        'ground_truth/path': _path('world', *motion.columns('x', 'y')),
        'surroundings': surroundings(record.obstacles, touches, route),
    }
    if TFMessage is not None:
        still['tf_static'] = fixed_transforms()
        still['tf_static'].transforms.append(_odom_in_world(start))
    topics = [
        Topic(f'{space}{name}', type(each), [(first_ns, _bytes(each))], latched=True)
        for name, each in still.items()
    ]
    topics += [
        Topic(f'{space}ground_truth/robot', MarkerArray, motion.robot()),
        Topic(f'{space}odometry/filtered', Odometry, motion.filtered()),
        Topic(f'{space}ground_truth/odom', Odometry, motion.truth()),
        Topic(f'{space}husky_velocity_controller/cmd_vel', Twist, motion.commands(report.begin)),
        Topic(f'{space}collisions', DiagnosticStatus, collisions),
        Topic(f'{space}cross_track_error', Float64, motion.errors(report)),
    ]
    if TFMessage is not None:
        topics.append(Topic(f'{space}tf', TFMessage, motion.transforms()))
    return topics


class _Motion:
    """The rows of a robot as messages."""

    def __init__(self, record: Record, place: int) -> None:
        self._column = partial(record.column, place)
        self.times_ns = [_ns(time_sec) for time_sec in record.time_sec.tolist()]

    def columns(self, *names: str) -> list[Array]:
        """Return the values of all rows."""
        return list(map(self._column, names))

    def filtered(self) -> Messages:
        """Yield where odometry believed the robot, with the twist by which it came there."""
        x, y, yaw = self.columns('odom_x', 'odom_y', 'odom_yaw')
        yaw = np.asarray(np.unwrap(yaw), dtype=np.float64)
        turn = np.diff(yaw, prepend=yaw[0])
        heading = yaw - turn / 2
        way = np.diff(x, prepend=x[0]) * np.cos(heading)
        way += np.diff(y, prepend=y[0]) * np.sin(heading)
        rates = way / CONTROL_PERIOD_SEC, turn / CONTROL_PERIOD_SEC
        return self._odometry('odom', x, y, yaw, *rates)

    def truth(self) -> Messages:
        """Yield where the robot was."""
        names = ('x', 'y', 'yaw', 'speed_m_s', 'yaw_rate_rad_s')
        return self._odometry('world', *self.columns(*names))

    def robot(self) -> Messages:
        """Yield the robot where it was, to be drawn."""
        message = RobotMarkers()
        for time_ns, x, y, yaw in self._rows(*self.columns('x', 'y', 'yaw')):
            message.pack(_stamp(time_ns), x, y, yaw)
            yield time_ns, bytes(message)

    def transforms(self) -> Messages:
        """Yield where base_link was believed in odom."""
        message = PackedMessage(TFMessage(transforms=[new_transform('odom', 'base_link')]))
        place = message.places['transforms'][0]
        pack_stamp = message.packer(place['header']['stamp'])
        pack = message.packer(place['transform'])
        names = ('odom_x', 'odom_y', 'odom_yaw')
        for time_ns, x, y, yaw in self._rows(*self.columns(*names)):
            pack_stamp(*_stamp(time_ns))
            pack(x, y, 0.0, *_quaternion(yaw))
            yield time_ns, bytes(message)

    def commands(self, begin: int) -> Messages:
        """Yield the command of each control period when that begins, from the first on."""
        names = ('command_speed_m_s', 'command_yaw_rate_rad_s')
        speeds, yaw_rates = (self._column(name)[begin + 1 :].tolist() for name in names)
        message = PackedMessage(Twist())
        pack = message.packer(message.places)
        for time_ns, speed, yaw_rate in zip(
            self.times_ns[begin:-1], speeds, yaw_rates, strict=True
        ):
            pack(speed, 0.0, 0.0, 0.0, 0.0, yaw_rate)
            yield time_ns, bytes(message)

    def errors(self, report: Report) -> Messages:
        """Yield how far the robot was off the path, positive to its left, while it drove."""
        drive = slice(report.begin, report.end + 1)
        message = PackedMessage(Float64())
        pack = message.packer(message.places)
        for time_ns, error_m in zip(
            self.times_ns[drive], report.errors_m[drive].tolist(), strict=True
        ):
            pack(error_m)
            yield time_ns, bytes(message)

    def _odometry(
        self, frame_id: str, x: Array, y: Array, yaw: Array, speed: Array, yaw_rate: Array
    ) -> Messages:
        message = OdometryMessage(frame_id, _UNKNOWN)
        rows = self._rows(x, y, yaw, speed, yaw_rate)
        for time_ns, east, north, heading, forward, turn in rows:
            message.pack_stamp(*_stamp(time_ns))
            message.pack_pose(east, north, 0.0, *_quaternion(heading))
            message.pack_twist(forward, 0.0, 0.0, 0.0, 0.0, turn)
            yield time_ns, bytes(message)

    def _rows(self, *columns: Array) -> Iterator[Any]:
        return zip(self.times_ns, *(column.tolist() for column in columns), strict=True)


def _path(frame_id: str, x: Sequence[float] | Array, y: Sequence[float] | Array) -> PathMessage:
    path = PathMessage()
    path.header.frame_id = frame_id
    for east, north in zip([*x[:-1:EVERY], x[-1]], [*y[:-1:EVERY], y[-1]], strict=True):
        stamped = PoseStamped()
        stamped.header.frame_id = frame_id
        stamped.pose.position.x, stamped.pose.position.y = float(east), float(north)
        path.poses.append(stamped)
    return path


def _odom_in_world(start: RobotStart) -> Any:
    transform = new_transform('world', 'odom', (start.x, start.y, 0.0))
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = _quaternion(start.yaw)
    return transform


def _quaternion(yaw: float) -> tuple[float, float, float, float]:
    return 0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0)


def _ns(time_sec: float) -> int:
    return round(time_sec * 1e9)


def _stamp(time_ns: int) -> tuple[int, int]:
    return divmod(time_ns, 10**9)


def _bytes(message: Any) -> bytes:
    return bytes(PackedMessage(message))
