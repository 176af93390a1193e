# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulation: physics and controllers, advanced by whole control periods.

It uses neither ROS nor the wall clock, so a run is a function of the world file, the settings
and the commands, bit for bit.
"""

import math

from husky_course.robot import RobotStart
import mujoco
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC, FLOORS, SimulationConfig
from husky_sim.robot.battery import Battery
from husky_sim.robot.broadphase import BroadPhase
from husky_sim.robot.contacts import Collision, TouchDetector
from husky_sim.robot.diff_drive import VelocityController, WheelOdometry
from husky_sim.robot.husky import Husky
from husky_sim.robot.motors import Motors
from husky_sim.robot.tyres import Tyres
from husky_sim.sensors.imu import Imu, new_noise
from husky_sim.sensors.localization import PlanarFilter
from husky_sim.sensors.ray_scene import RayScene
from husky_sim.sensors.sensors import Sensors
from husky_sim.world.world import load_world, World

PERIOD_NS = round(CONTROL_PERIOD_SEC * 1e9)


class SimulatedRobot:
    """A Husky with its controller and its estimates, as of the end of the last control period."""

    def __init__(
        self,
        start: RobotStart,
        world: World,
        data: mujoco.MjData,
        config: SimulationConfig,
        *,
        seed: list[int],
        scene: RayScene | None = None,
    ) -> None:
        self.name = start.name
        self.start = start
        self.is_stopped = False  # by the emergency stop, which a reset does not release
        self.husky = Husky(start.name, world.model, data)
        self.controller = VelocityController(config.drive)
        self.odometry = WheelOdometry(config.drive)
        self.filtered = PlanarFilter(CONTROL_PERIOD_SEC)
        power = config.power
        self.battery = Battery(power.battery_charge) if power.battery else None
        self.motors = Motors(self.husky, self.battery) if self.battery is not None else None
        self._imu = Imu(self.husky, new_noise([*seed, 0]) if config.has_noise else None)
        self.sensors = Sensors(
            start.name,
            scene,
            config.sensors,
            self.battery,
            noise=config.has_noise,
            seed=seed,
        )
        self.reset()

    def reset(self) -> None:
        """Forget the run; the physics must have been reset before."""
        self.controller.reset()
        self.odometry.reset()
        self._imu.reset()
        self.sensors.reset()
        self.command_timed_out = self.battery_ran_empty = self._was_empty = False
        self.turned_over = self._was_turned_over = False
        if self.motors is not None:
            self.motors.reset()
        self._measure()
        self.filtered.reset(self.imu.yaw)

    def act(self, time_sec: float) -> None:
        """Turn the last command into wheel speeds for the coming period."""
        self.command_timed_out = self.controller.update(
            time_sec=time_sec, period_sec=CONTROL_PERIOD_SEC
        )
        driven = self.motors or self.husky
        driven.drive(*self.controller.wheel_speeds_rad_s())

    def observe(self, periods: int) -> None:
        """Read the physics at the end of a period, and update the estimates."""
        self._measure()
        is_turned_over = self.state.is_turned_over
        self.turned_over = is_turned_over and not self._was_turned_over  # once, until a reset
        self._was_turned_over |= is_turned_over
        if self.battery is not None:
            self.battery_ran_empty = self.battery.is_empty and not self._was_empty
            self._was_empty = self.battery.is_empty
        self.sensors.measure(self.state, periods)
        self.filtered.update(
            wheel_speed_m_s=self.odometry.speed_m_s,
            wheel_yaw_rate_rad_s=self.odometry.yaw_rate_rad_s,
            imu_yaw=self.imu.yaw,
            imu_yaw_rate_rad_s=self.imu.angular_velocity[2],
        )

    def _measure(self) -> None:
        self.state = self.husky.state()
        self.wheels = self.husky.wheels()
        self.imu = self._imu.measure(self.state, CONTROL_PERIOD_SEC)
        self.odometry.update(
            self.wheels.left_rad, self.wheels.right_rad, period_sec=CONTROL_PERIOD_SEC
        )


class Simulation:
    """Robots in a world. Not for use by two threads at once."""

    def __init__(self, config: SimulationConfig, *, visual: bool = True) -> None:
        """
        Load the world.

        :param visual: keep what is only seen, for a camera or a picture.
        :raises SimulatorError: if the world or a start pose cannot be used.
        """
        self.config = config
        self._visual = visual
        self.world = self._load(visual=visual)
        self.model = self.world.model
        self.data = mujoco.MjData(self.model)
        self._tyres = Tyres(self.world, self.data, FLOORS[config.ground.floor])
        self.touches: list[Collision] = []
        self.periods = 0
        self.broadphase = BroadPhase(self.world, self.data)
        self._detector = TouchDetector(self.world, self.data)
        scene = self.ray_scene() if config.sensors.lidar_rate_hz > 0.0 else None
        self.robots = [
            SimulatedRobot(
                *(start, self.world, self.data, config),
                seed=[config.sensors.seed, number],
                scene=scene,
            )
            for number, start in enumerate(config.robots)
        ]
        self._motors = [robot.motors for robot in self.robots if robot.motors is not None]

    def _load(self, *, visual: bool) -> World:
        config = self.config
        return load_world(
            config.world, config.robots, visual=visual, load_y_m=config.body.load_y_m
        )

    def ray_scene(self) -> RayScene:
        """Make what the beams of lasers meet: all of the world, also what is only seen."""
        world = self.world if self._visual else self._load(visual=True)
        return RayScene(world, self.data)

    @property
    def time_ns(self) -> int:
        """Return the simulated time, exactly."""
        return self.periods * PERIOD_NS

    @property
    def stamp(self) -> tuple[int, int]:
        """Return the simulated time as messages have it: seconds, nanoseconds."""
        return divmod(self.time_ns, 1_000_000_000)

    @property
    def time_sec(self) -> float:
        """Return the simulated time."""
        return self.periods * PERIOD_NS / 1e9

    @property
    def physics_warnings(self) -> int:
        """Return how often MuJoCo has warned since the last reset; 0 in a healthy run."""
        return int(sum(self.data.warning.number.tolist()))

    @property
    def breakdown(self) -> str:
        """Return in one line that MuJoCo could not compute something, and where; or nothing."""
        if not (name := self._broken_down()):
            return ''
        return (
            f'the physics broke down at {name}, and everything is back at its start: this run is '
            f'not to be trusted; give it a softer spring or more mass in {self.world.path}, or '
            'that a shorter timestep'
        )

    def _broken_down(self) -> str:
        """
        Return the name of what MuJoCo could not compute, or nothing.

        It then puts everything back to its start, and begins to count its warnings anew.
        """
        warnings = self.data.warning
        for kind, starts in (
            (mujoco.mjtWarning.mjWARN_BADQPOS, self.model.jnt_qposadr),
            (mujoco.mjtWarning.mjWARN_BADQVEL, self.model.jnt_dofadr),
            (mujoco.mjtWarning.mjWARN_BADQACC, self.model.jnt_dofadr),
        ):
            if warnings[kind].number:
                after = np.searchsorted(starts, warnings[kind].lastinfo, side='right')
                body = int(self.model.jnt_bodyid[after - 1])
                return self.model.body(body).name or f'body {body}'
        return ''

    def advance(self) -> None:
        """
        Advance by one control period.

        Afterwards the robots hold what their sensors say at its end, and `touches` holds the
        collisions whose report fell due.
        """
        begin_sec = self.time_sec
        for robot in self.robots:
            robot.act(begin_sec)
        self._tyres.update()
        self.broadphase.update()
        if self.broadphase.alone and not self._motors:
            mujoco.mj_step(self.model, self.data, self.world.steps_per_period)
        else:
            self._step_by_step(begin_sec)
        self.periods += 1
        for robot in self.robots:
            robot.observe(self.periods)
        self.touches = self._detector.reports(self.time_sec)

    def _step_by_step(self, begin_sec: float) -> None:
        timestep_sec = self.model.opt.timestep
        for step in range(1, self.world.steps_per_period + 1):
            mujoco.mj_step(self.model, self.data)
            for motors in self._motors:
                motors.step(timestep_sec)
            if self.broadphase.alone:
                continue
            if self._detector.update(begin_sec + step * timestep_sec):
                self._tyres.meet_obstacles()

    @property
    def only_robots_awake(self) -> bool:
        """Whether nothing but the robots has moved in the last control period."""
        return int(self.data.ntree_awake) == len(self.robots)

    def unreported_touches(self) -> list[Collision]:
        """Return the touches of the last moments, whose force had no time to reach its peak."""
        return self._detector.reports(math.inf)

    def reset(self) -> None:
        """Put everything back as it was at the start, bit for bit."""
        self.broadphase.reset()  # first: what touches, sleeps together, and is woken together
        mujoco.mj_resetData(self.model, self.data)
        self._tyres.reset()
        self._detector.reset()
        self.touches = []
        self.periods = 0
        for robot in self.robots:
            robot.reset()
