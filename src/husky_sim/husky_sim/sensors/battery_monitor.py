# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What an A200 knows of its battery: voltage, current, and a charge that it guesses from them.

As clearpath_robot's battery_state_estimator does on ROS 2 Jazzy, the charge is that of a battery
at rest with the mean voltage of the last readings. So it is too low while the robot works hard.
"""

from collections import deque
import math
from typing import NamedTuple

from husky_sim.robot.battery import Battery, charge_at_rest

READINGS = 30
EVERY_PERIODS = 12
"""The A200's hardware interface asks for the status with each twelfth reading, of 50 a second."""


class BatteryReading(NamedTuple):
    """One measurement; the current is positive while the battery is drawn from, as on the A200."""

    voltage_v: float
    current_a: float
    charge: float


class BatteryMonitor:
    """Measures a battery."""

    def __init__(self, battery: Battery) -> None:
        self._battery = battery
        self._voltages_v: deque[float] = deque(maxlen=READINGS)

    def reset(self) -> None:
        """Forget every reading."""
        self._voltages_v.clear()

    def measure(self, periods: int) -> BatteryReading | None:
        """Return a measurement where one falls on the end of this control period."""
        if periods % EVERY_PERIODS:
            return None
        voltage_v = self._battery.voltage_v
        self._voltages_v.append(voltage_v)
        mean_v = math.fsum(self._voltages_v) / len(self._voltages_v)
        return BatteryReading(voltage_v, self._battery.current_a, charge_at_rest(mean_v))
