# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The simulated Husky of an environment: where it starts, what it measures, what is recorded."""

import math

from husky_course.frames import Pose, to_odom, to_world, wrapped
from husky_course.record import Collision
from husky_course.robot import RobotStart
from husky_sim.errors import SimulatorError
from husky_sim.sensors import Lidar, new_noise, RANGE_MAX_M, Rate, RayScene
from husky_sim.simulation import SimulatedRobot, Simulation
from husky_sim.world import default_worlds
import mujoco
import numpy as np

from husky_gym.observation import Estimate, Floats
from husky_gym.settings import EnvironmentSettings
from husky_sim.config import GroundConfig, SensorConfig, SimulationConfig


class Husky:
    """One robot in a world of its own, driven by a control period at a time."""

    def __init__(self, settings: EnvironmentSettings, *, visual: bool) -> None:
        """
        Load the world.

        :param visual: keep what is only seen, for pictures.
        :raises ValueError: if the world or the start cannot be used.
        """
        self._settings = settings
        self.start = RobotStart(x=settings.start_x, y=settings.start_y, yaw=settings.start_yaw)
        self._config = SimulationConfig(
            world=settings.world or str(default_worlds() / 'playpen.xml'),
            robots=(self.start,),
            ground=GroundConfig(floor=settings.floor),
            sensors=SensorConfig(noise=settings.noise, navsat_rate_hz=0.0),
        )
        try:
            self.simulation = Simulation(self._config, visual=visual)
        except SimulatorError as error:
            raise ValueError(str(error)) from None
        self._scans = Rate(settings.laser_rate_hz)
        self._laser: Lidar | None = None
        self._scene: RayScene | None = None
        self.ranges: Floats | None = None  # of the last scan, in metres; None without a laser
        # Where the robot believes to be, as its odometry starts where it starts; where it is.
        self.estimate: Estimate = (0.0, 0.0, 0.0, 0.0, 0.0)
        self.place = (0.0, 0.0)  # in the frame of the course, as the estimate

    @property
    def robot(self) -> SimulatedRobot:
        return self.simulation.robots[0]

    def begin(self, offset: Pose, noise_seed: int) -> None:
        """Put everything back to a start that lies at `offset` in the frame of the course."""
        simulation, beams = self.simulation, self._settings.laser_beams
        simulation.reset()
        self._offset = offset
        if any(offset):
            self._place(simulation.data, offset)
        seed = [noise_seed, 0]
        simulation.robots = [
            SimulatedRobot(self.start, simulation.world, simulation.data, self._config, seed=seed)
        ]
        if beams and (self._laser is None or self._settings.noise):
            noise = new_noise([*seed, 1], beams) if self._settings.noise else None
            if self._scene is None:
                self._scene = simulation.ray_scene()
            self._laser = Lidar(self.start.name, self._scene, noise, beams=beams)
        self._read()
        self._scan()

    def is_free(self, offset: Pose) -> bool:
        """Tell whether a robot that starts there touches nothing but the ground."""
        world = self.simulation.world
        self.simulation.broadphase.reset()
        data = mujoco.MjData(world.model)
        self._place(data, offset)
        mujoco.mj_forward(world.model, data)
        owners = world.touching(data)
        return not ((owners >= 0).all(axis=1) & (owners[:, 0] != owners[:, 1])).any()

    def _place(self, data: mujoco.MjData, offset: Pose) -> None:
        x, y = to_world(self.start.pose, offset[0], offset[1])
        half_rad = (self.start.yaw + offset[2]) / 2.0
        place = data.joint(f'{self.start.name}/base_joint').qpos
        place[:2] = x, y
        place[3:7] = math.cos(half_rad), 0.0, 0.0, math.sin(half_rad)

    def drive(self, speed_m_s: float, yaw_rate_rad_s: float) -> list[Collision]:
        """Drive for one control period; return the touches whose report fell due."""
        simulation = self.simulation
        self.robot.controller.command(speed_m_s, yaw_rate_rad_s, time_sec=simulation.time_sec)
        simulation.advance()
        self._read()
        if self._scans.is_due(simulation.periods):
            self._scan()
        return simulation.touches

    def _read(self) -> None:
        filtered = self.robot.filtered
        x, y = to_world(self._offset, filtered.x, filtered.y)
        yaw = wrapped(self._offset[2] + filtered.yaw)
        self.estimate = (x, y, yaw, filtered.speed_m_s, filtered.yaw_rate_rad_s)
        self.place = to_odom(self.start.pose, *self.robot.state.position[:2])

    def _scan(self) -> None:
        if self._laser is not None:
            scan = self._laser.scan(self.robot.state, 1.0 / self._settings.laser_rate_hz)
            self.ranges = np.clip(scan, 0.0, RANGE_MAX_M)

    def row(self) -> tuple[float, ...]:
        """Return the columns of a record, see `husky_course.record.COLUMNS`."""
        robot, state = self.robot, self.robot.state
        return (
            *(self.simulation.time_sec, state.position[0], state.position[1], state.yaw),
            *self.estimate[:3],
            *(state.velocity[0], state.angular_velocity[2]),
            *(robot.controller.asked_speed_m_s, robot.controller.asked_yaw_rate_rad_s),
        )
