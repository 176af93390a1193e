# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive a route in one process: the simulator's physics and the driver, without DDS between them.

In lockstep each odometry message is answered by one command, here as between the two nodes; so
the trajectory is the same, bit for bit, in a fraction of the time.
"""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import lru_cache
import gc
import math
from pathlib import Path
from tempfile import TemporaryDirectory

from husky_course.frames import Pose, to_odom, wrapped
from husky_course.record import FILE_NAME, read_record, Record
from husky_course.robot import RobotStart
from husky_course.route import Route
from husky_driver.drive import Drive
from husky_driver.motion import Command, ImuReading, Odometry, read_imu, yaw_of
from husky_sim.errors import SimulatorError
from husky_sim.recording import RunRecorder
from husky_sim.simulation import SimulatedRobot, Simulation
from husky_sim.world import default_worlds

from husky_sim.config import (
    BodyConfig,
    CONTROL_PERIOD_SEC,
    GroundConfig,
    PowerConfig,
    SensorConfig,
    SimulationConfig,
)

PERIODS_A_SECOND = round(1.0 / CONTROL_PERIOD_SEC)

Controller = Callable[[Odometry], Command | None]
OnImu = Callable[[ImuReading], None]


@dataclass(frozen=True)
class Conditions:
    """What a run meets that its course does not say; by default those of every grading."""

    floor: str = GroundConfig.floor
    realistic: bool = False
    battery: bool = False
    seed: int = 0


def drive_route(
    route: Route,
    *,
    world: str = '',
    start: Pose = (0.0, 0.0, 0.0),
    odometry: str = 'filtered',
    record: Path | None = None,
    each_second: Callable[[], object] = lambda: None,
    conditions: Conditions | None = None,
) -> tuple[Record, Drive]:
    """
    Drive a route to its end; return the simulator's record and the drive.

    :param world: MJCF file; empty: the playpen.
    :param odometry: which pose to follow: filtered, wheel or ground_truth.
    :param record: the file to keep the record in; None keeps none.
    :param each_second: called with every second of simulated time.
    :raises ValueError: when the world or the start cannot be used, or the physics breaks down.
    :raises OSError: when the record cannot be written.
    """
    drive = Drive(route, slip=odometry != 'ground_truth')
    driven = drive_with(
        drive.step,
        on_imu=drive.add_imu,
        world=world,
        start=start,
        odometry=odometry,
        record=record,
        each_second=each_second,
        conditions=conditions,
    )
    return driven, drive


def drive_with(
    controller: Controller,
    *,
    on_imu: OnImu = lambda _reading: None,
    world: str = '',
    start: Pose = (0.0, 0.0, 0.0),
    odometry: str = 'filtered',
    limit_sec: float = math.inf,
    record: Path | None = None,
    each_second: Callable[[], object] = lambda: None,
    conditions: Conditions | None = None,
) -> Record:
    """
    Let a controller answer each odometry until it answers None; return the record.

    :param on_imu: called with each sample of the IMU.
    :param limit_sec: for a controller that never answers None; a `Drive` has a limit of its own.
    :raises ValueError: when the world or the start cannot be used, or the physics breaks down.
    """
    simulation = _at_start(world, start, conditions or Conditions())
    with ExitStack() as stack:
        file = record or Path(stack.enter_context(TemporaryDirectory())) / FILE_NAME
        with RunRecorder(simulation, file) as recorder:
            (robot,) = simulation.robots
            while simulation.time_sec < limit_sec:
                command = controller(_odometry(_time_sec(simulation), robot, odometry))
                if command is None:
                    break
                robot.controller.command(*command, time_sec=simulation.time_sec)
                simulation.advance()
                on_imu(_imu(_time_sec(simulation), robot))
                recorder.append()
                if simulation.periods % PERIODS_A_SECOND == 0:
                    each_second()
        if wrong := simulation.breakdown:
            raise ValueError(wrong)  # of the world; what it has recorded is no drive
        return read_record(file)


def _at_start(world: str, start: Pose, conditions: Conditions) -> Simulation:
    x, y, yaw = start
    config = SimulationConfig(
        world=world or str(default_worlds() / 'playpen.xml'),
        robots=(RobotStart(x=x, y=y, yaw=yaw),),
        ground=GroundConfig(floor=conditions.floor),
        body=BodyConfig(realistic=conditions.realistic),
        power=PowerConfig(battery=conditions.battery),
        sensors=SensorConfig(seed=conditions.seed),
    )
    try:
        simulation = _loaded(config)
    except SimulatorError as error:
        raise ValueError(str(error)) from None
    simulation.reset()
    return simulation


@lru_cache(maxsize=1)
def _loaded(config: SimulationConfig) -> Simulation:
    """Keep the last world: a class drives a hundred courses in the same one."""
    simulation = Simulation(config, visual=False)
    gc.freeze()  # garbage collections look no more at what stays
    return simulation


def _odometry(time_sec: float, robot: SimulatedRobot, odometry: str) -> Odometry:
    """Return the odometry as the driver gets it, to the last bit of the message."""
    if odometry == 'ground_truth':
        state, start = robot.state, robot.start
        x, y = to_odom(start.pose, state.position[0], state.position[1])
        yaw = wrapped(state.yaw - start.yaw)
        return Odometry(time_sec, x, y, yaw, state.velocity[0], state.angular_velocity[2])
    pose = robot.filtered if odometry == 'filtered' else robot.odometry
    return Odometry(
        time_sec,
        pose.x,
        pose.y,
        yaw_of(0.0, 0.0, math.sin(pose.yaw / 2.0), math.cos(pose.yaw / 2.0)),
        pose.speed_m_s,
        pose.yaw_rate_rad_s,
    )


def _time_sec(simulation: Simulation) -> float:
    """Return the time as a stamp gives it."""
    seconds, nanoseconds = simulation.stamp
    return seconds + nanoseconds * 1e-9


def _imu(time_sec: float, robot: SimulatedRobot) -> ImuReading:
    (w, x, y, z), (ahead, left, _) = robot.imu.orientation, robot.imu.acceleration
    return read_imu(time_sec, (ahead, left), x, y, z, w)
