# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Settings of the simulator: the only place a default lives.

Values of the velocity controller are those of husky_control for ROS Noetic
(husky/husky noetic-devel, config/control.yaml) and of the A200's URDF.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

from husky_course.robot import RobotStart
from husky_runtime.settings import setting, settings_of

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


class Floor(NamedTuple):
    """Friction coefficients of the tyres: along, where a wheel rolls to, and across."""

    along: float
    across: float


FLOORS = {
    'ideal': Floor(1.5, 1.5),
    'asphalt': Floor(1.0, 1.0),
    'concrete_indoor': Floor(0.75, 0.585),
    'wet': Floor(0.5, 0.45),
    'gravel': Floor(0.5, 0.525),
    'grass': Floor(0.35, 0.385),
}


@dataclass(frozen=True, kw_only=True)
class GroundConfig:
    """What the robots drive on."""

    floor: str = setting('asphalt', f'How the tyres grip: {", ".join(FLOORS)}.', choices=FLOORS)


LOAD_Y_M = -0.085
"""The centre of mass in the original's file, which puts 62 % of the weight on the right wheels."""


@dataclass(frozen=True, kw_only=True)
class BodyConfig:
    """How a robot differs from one that is built as it is drawn."""

    realistic: bool = setting(False, "The original's noise and its unequal loads, together.")
    center_of_mass_y_m: float = setting(
        0.0,
        "Where the weight is, to the left of the middle; the original's file: -0.085.",
        -0.2,
        0.2,
    )

    @property
    def load_y_m(self) -> float:
        """Where the weight is, to the left of the middle, all settings considered."""
        return self.center_of_mass_y_m or (LOAD_Y_M if self.realistic else 0.0)


@dataclass(frozen=True, kw_only=True)
class PowerConfig:
    """What the motors run on."""

    battery: bool = setting(
        False, 'Motors are limited by their power, and the battery sags and runs down.'
    )
    battery_charge: float = setting(
        1.0, 'How full the battery is at the start, with battery; 1: full.', 0.0, 1.0
    )


LEAST_RATE_HZ = 0.001
"""A message tells the time to the next one, which must be a number."""


@dataclass(frozen=True, kw_only=True)
class SensorConfig:
    """Which sensors measure, how often, and how well."""

    noise: bool = setting(False, "Noise and drift of the original's sensors.")
    seed: int = setting(0, 'Seed of the noise; the same seed gives the same run.', 0, 2**32 - 1)
    localization: bool = setting(
        True, 'Publish odometry/filtered; false where robot_localization does.'
    )
    navsat_rate_hz: float = setting(
        40.0, 'Rate of navsat/fix; 0: off.', LEAST_RATE_HZ, 50.0, or_zero=True
    )
    lidar_rate_hz: float = setting(
        0.0, 'Rate of front/scan; 0: off.', LEAST_RATE_HZ, 50.0, or_zero=True
    )
    camera_rate_hz: float = setting(
        0.0, 'Rate of camera/image_raw; 0: off.', LEAST_RATE_HZ, 50.0, or_zero=True
    )


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
        1.0,
        'Simulated seconds a second, 0.001 or more; 0: as fast as possible.',
        0.001,
        1000.0,
        changeable=True,
        or_zero=True,
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
    body: BodyConfig = field(default_factory=BodyConfig)
    power: PowerConfig = field(default_factory=PowerConfig)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Return what a run depends on and is not the default, as launch arguments say it."""
        parts = (self.drive, self.ground, self.sensors, self.body, self.power)
        given = [
            (each.name, getattr(part, each.name))
            for part in parts
            for each in settings_of(part)
            if each.name not in self._unfelt and getattr(part, each.name) != each.default
        ]
        return tuple(
            f'{name}:={str(value).lower() if isinstance(value, bool) else value}'
            for name, value in given
        )

    @property
    def _unfelt(self) -> tuple[str, ...]:
        """Return the settings that move no robot."""
        unfelt = ['localization', 'navsat_rate_hz', 'lidar_rate_hz', 'camera_rate_hz']
        if not self.has_noise:
            unfelt.append('seed')
        if not self.power.battery:
            unfelt.append('battery_charge')
        return tuple(unfelt)

    @property
    def has_noise(self) -> bool:
        """Whether sensors err."""
        return self.sensors.noise or self.body.realistic
