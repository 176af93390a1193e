# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Settings of the simulator: the only place a default lives.

Values of the velocity controller are those of husky_control for ROS Noetic
(husky/husky noetic-devel, config/control.yaml) and of the A200's URDF.
"""

from dataclasses import dataclass, field

from husky_course.robot import RobotStart
from husky_runtime.settings import setting

CONTROL_PERIOD_SEC = 0.02
"""The velocity controller, the odometry and the IMU all run at 50 Hz."""


@dataclass(frozen=True, kw_only=True)
class DriveConfig:
    """The kinematic model and the limits of the velocity controller."""

    wheel_separation_m: float = setting(
        0.5708 * 1.875, 'Track of the kinematic model: 1.875 times the geometric one.', 0.1, 5.0
    )
    wheel_radius_m: float = setting(0.1651, 'Wheel radius of the kinematic model.', 0.01, 1.0)
    speed_limit_m_s: float = setting(1.0, 'Greatest speed, forward and backward.', 0.0, 10.0)
    acceleration_limit_m_s2: float = setting(3.0, 'Greatest change of speed.', 0.01, 100.0)
    yaw_rate_limit_rad_s: float = setting(2.0, 'Greatest turn rate, left and right.', 0.0, 20.0)
    yaw_acceleration_limit_rad_s2: float = setting(
        6.0, 'Greatest change of the turn rate.', 0.01, 200.0
    )
    command_timeout_sec: float = setting(
        0.25, 'The wheels stop when the last command is older than this, in sim time.', 0.02, 60.0
    )


GRIP = {'ideal': 1.5, 'asphalt': 1.0, 'gravel': 0.3}
"""What the friction of the tyres, which husky.xml has for asphalt, is multiplied with."""


@dataclass(frozen=True, kw_only=True)
class GroundConfig:
    """What the robots drive on."""

    slip: str = setting('asphalt', 'How the tyres grip: ideal, asphalt or gravel.', choices=GRIP)


@dataclass(frozen=True, kw_only=True)
class SensorConfig:
    """Which sensors measure, how often, and how well."""

    noise: bool = setting(False, "Noise and drift of the original's sensors.")
    seed: int = setting(0, 'Seed of the noise; the same seed gives the same run.')
    localization: bool = setting(
        True, 'Publish odometry/filtered; false where robot_localization does.'
    )
    navsat_rate_hz: float = setting(40.0, 'Rate of navsat/fix; 0: off.', 0.0, 50.0)
    lidar_rate_hz: float = setting(0.0, 'Rate of front/scan; 0: off.', 0.0, 50.0)
    camera_rate_hz: float = setting(0.0, 'Rate of camera/image_raw; 0: off.', 0.0, 50.0)


@dataclass(frozen=True, kw_only=True)
class StartConfig:
    """Where the only robot starts: metres and radians in the frame `world`."""

    x: float = setting(0.0, 'Start in the frame world, m.', -1000.0, 1000.0)
    y: float = setting(0.0, 'Start in the frame world, m.', -1000.0, 1000.0)
    yaw: float = setting(0.0, 'Heading at the start, rad.', -1000.0, 1000.0)


INTERFACES = ('lab', 'clearpath')


@dataclass(frozen=True, kw_only=True)
class RunConfig:
    """How time passes, and what is kept of a run."""

    world: str = setting('', 'MJCF file of the world; empty: the playpen.')
    real_time_factor: float = setting(
        1.0, 'Simulated seconds a second; 0: as fast as possible.', 0.0, 1000.0, changeable=True
    )
    lockstep: bool = setting(
        False, 'Wait for a command after each odometry message, then advance one control period.'
    )
    interface: str = setting(
        'lab',
        "Topics: lab, or clearpath: those of a real A200 on ROS 2 Jazzy beside the lab's.",
        choices=INTERFACES,
    )
    record: str = setting('', 'File for the record of the run, written as it goes; empty: none.')
    limit_sec: float = setting(
        0.0, 'End after so much simulated time, s: a run whose driver hangs; 0: never.', 0.0, 1e9
    )


@dataclass(frozen=True, kw_only=True)
class SimulationConfig:
    """What a run is a function of, besides the commands."""

    world: str
    robots: tuple[RobotStart, ...] = (RobotStart(),)
    drive: DriveConfig = field(default_factory=DriveConfig)
    ground: GroundConfig = field(default_factory=GroundConfig)
    sensors: SensorConfig = field(default_factory=SensorConfig)
