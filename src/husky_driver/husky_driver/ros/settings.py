# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of `follow_path`: the only place where their defaults live."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from husky_course.frames import Pose
from husky_course.route import A200_LIMITS, DriveLimits, LIMITS
from husky_runtime.settings import Setting, setting, settings_of

from husky_driver.checks.path_scan import LASER_X_M


@dataclass(frozen=True)
class Interface:
    """The topics of a robot, without its namespace."""

    commands: str
    stamped: bool  # commands are TwistStamped
    odometry: Mapping[str, str]  # topics by what they tell
    imu: str
    has_reliable_imu: bool
    scan: str


LAB = Interface(
    commands='husky_velocity_controller/cmd_vel',
    stamped=False,
    odometry={
        'filtered': 'odometry/filtered',
        'wheel': 'husky_velocity_controller/odom',
        'ground_truth': 'ground_truth/odom',
    },
    imu='imu/data',
    has_reliable_imu=True,
    scan='front/scan',
)
# Of a real A200 on ROS 2 Jazzy: Clearpath's Platform API and Sensors API. Only the simulator can
# tell the ground truth.
CLEARPATH = Interface(
    commands='cmd_vel',
    stamped=True,
    odometry={
        'filtered': 'platform/odom/filtered',
        'wheel': 'platform/odom',
        'ground_truth': 'ground_truth/odom',
    },
    imu='sensors/imu_0/data',
    has_reliable_imu=False,
    scan='sensors/lidar2d_0/scan',
)
INTERFACES = {'lab': LAB, 'clearpath': CLEARPATH}
ROBOTS = {'lab': LIMITS, 'a200': A200_LIMITS}
PROGRESS = ('auto', 'bar', 'lines', 'off')


@dataclass(frozen=True)
class Settings:
    """What `--ros-args -p name:=value` can set."""

    waypoints: str = setting(
        '', 'file of waypoints to follow; empty: ask at the terminal', changeable=True
    )
    interface: str = setting(
        'lab',
        'topics of the robot: lab, or clearpath, those of a real A200',
        choices=INTERFACES,
    )
    limits: str = setting(
        'lab',
        'how quickly the robot obeys: lab, or a200, the lower limits of a real one',
        choices=ROBOTS,
    )
    odometry: str = setting(
        'filtered',
        'which pose to follow: filtered, wheel or ground_truth',
        choices=LAB.odometry,
    )
    odometry_timeout_sec: float = setting(
        5.0, 'give up when no odometry comes for so long, wall time', low=0.1, high=600.0
    )
    startup_timeout_sec: float = setting(
        5.0, 'the same before the first odometry: while the simulator starts', low=0.1, high=600.0
    )
    check: str = setting(
        'warn',
        'a course that passes too near to obstacles: warn, refuse, or off',
        choices=('warn', 'refuse', 'off'),
    )
    world: str = setting('', 'MJCF file with the obstacles to check against; empty: the playpen')
    start: tuple[float, ...] = setting(
        (0.0, 0.0, 0.0),
        'where the robot starts in that world, for check and ground_truth: x m, y m, yaw rad',
    )
    slip: bool = setting(True, 'count with the slip that odometry cannot see')
    imu: bool = setting(
        True, 'learn from the IMU how the robot slips, and whether something holds it'
    )
    imu_ahead_m: float = setting(
        0.0, 'where the IMU is in the robot: so far ahead of base_link', low=-2.0, high=2.0
    )
    scan: bool = setting(False, 'stop before what the laser sees on the path')
    laser_ahead_m: float = setting(
        LASER_X_M, 'where the laser is, upright: so far ahead of base_link', low=-1.0, high=1.0
    )
    progress: str = setting(
        'auto', 'how progress is shown: auto, bar, lines or off', choices=PROGRESS
    )

    def __post_init__(self) -> None:
        for each in settings_of(self):
            each.checked(getattr(self, each.name), refuse)
        if len(self.start) != 3:
            raise ValueError(f'parameter start: {len(self.start)} numbers; write [x, y, yaw]')

    @property
    def odometry_topic(self) -> str:
        return self.topics.odometry[self.odometry]

    @property
    def start_pose(self) -> Pose:
        """Where the robot starts in the frame world, in which the ground truth is."""
        x, y, yaw = self.start
        return x, y, yaw

    @property
    def topics(self) -> Interface:
        return INTERFACES[self.interface]

    @property
    def drive_limits(self) -> DriveLimits:
        return ROBOTS[self.limits]

    @property
    def has_slip(self) -> bool:
        """Whether the odometry which is followed misses something."""
        return self.slip and self.odometry != 'ground_truth'


def refuse(setting: Setting, given: Any) -> ValueError:
    """Return the error that says why a value of a setting is not allowed."""
    name, default = setting.name, setting.default
    if setting.choices:
        allowed = ', '.join(setting.choices)
        return ValueError(f'parameter {name}: {given!r} is not allowed; allowed: {allowed}')
    if setting.has_range:
        return ValueError(
            f'parameter {name}: {given!r} is not allowed; allowed is {setting.low:g} to '
            f'{setting.high:g}'
        )
    kinds = {str: 'text', bool: 'true or false'}
    example = list(default) if isinstance(default, tuple) else default
    return ValueError(
        f'parameter {name} must be {kinds.get(type(default), "of numbers")}, as {example!r}'
    )
