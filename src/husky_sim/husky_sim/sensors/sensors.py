# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The sensors with a rate of their own: which of them measures after a period."""

import math

import numpy as np
import numpy.typing as npt

from husky_sim.config import CONTROL_PERIOD_SEC, SensorConfig
from husky_sim.robot.battery import Battery
from husky_sim.robot.husky import RobotState
from husky_sim.sensors import lidar, navsat
from husky_sim.sensors.battery_monitor import BatteryMonitor, BatteryReading
from husky_sim.sensors.ray_scene import RayScene


class Rate:
    """Decides after which control periods a sensor measures: as evenly as possible."""

    def __init__(self, rate_hz: float) -> None:
        self._per_period = rate_hz * CONTROL_PERIOD_SEC

    def is_due(self, periods: int) -> bool:
        """Tell whether a measurement falls into the period that ends now."""
        before = math.floor((periods - 1) * self._per_period + 1e-9)  # rounding must not decide
        return math.floor(periods * self._per_period + 1e-9) > before


class Sensors:
    """
    The sensors of one robot.

    After `measure`, `scan`, `fix` and `battery` hold a new measurement, or None.
    """

    def __init__(
        self,
        name: str,
        scene: RayScene | None,
        config: SensorConfig,
        battery: Battery | None,
        *,
        noise: bool,
        seed: list[int],
    ) -> None:
        of_lidar = lidar.new_noise([*seed, 1]) if noise else None
        of_navsat = navsat.new_noise([*seed, 2]) if noise else None
        self._noises = [noise for noise in (of_lidar, of_navsat) if noise is not None]
        self._lidar: lidar.Lidar | None = None
        if scene is not None:
            self._lidar = lidar.Lidar(name, scene, of_lidar)
        self._navsat = navsat.NavSat(of_navsat)
        self._monitor = BatteryMonitor(battery) if battery is not None else None
        self._scans = Rate(config.lidar_rate_hz)
        self._fixes = Rate(config.navsat_rate_hz)
        self._scan_period_sec = 1.0 / (config.lidar_rate_hz or 1.0)
        self._fix_period_sec = 1.0 / (config.navsat_rate_hz or 1.0)
        self.scan: npt.NDArray[np.float32] | None = None
        self.fix: navsat.Fix | None = None
        self.battery: BatteryReading | None = None

    def reset(self) -> None:
        """Begin the same noise again."""
        for noise in self._noises:
            noise.reset()
        if self._monitor is not None:
            self._monitor.reset()
        self.scan = self.fix = self.battery = None

    def measure(self, state: RobotState, periods: int) -> None:
        """Measure what is due at the end of this control period."""
        self.scan = self.fix = None
        if self._lidar is not None and self._scans.is_due(periods):
            self.scan = self._lidar.scan(state, self._scan_period_sec)
        if self._fixes.is_due(periods):
            self.fix = self._navsat.locate(state.position, self._fix_period_sec)
        if self._monitor is not None:
            self.battery = self._monitor.measure(periods)
