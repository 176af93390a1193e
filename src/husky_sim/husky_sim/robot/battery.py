# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The battery of an A200: 24 V and 20 Ah of sealed lead-acid (Clearpath, A200 user manual).

A source behind a resistance: the more power is drawn, the lower the voltage. What a lead-acid
battery does besides is left out: it gives less charge at high currents, recovers slowly, and ages.
"""

from bisect import bisect_right
from collections.abc import Sequence
import math

BATTERIES = 2
"""In a row."""
CAPACITY_AH = 20.0
POWER_W = 1800.0
"""The most it delivers, by the same manual."""

OPEN_CIRCUIT_V = (23.2, 23.4, 23.8, 24.0, 24.4, 24.6, 24.8, 25.0, 25.1, 25.2, 25.3, 25.4)
CHARGES = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0)
"""Voltage at rest over charge: twice the table for lead-acid in clearpath_robot's battery.py."""

RESISTANCE_OHM = 0.05
"""
Of a full one. Two batteries of 20 Ah have 12 mOhm each (data sheet of SigmasTek's SP12-20-DZM);
the rest, for leads, plug and fuses, is a choice, and so is that it doubles until it is empty.
"""

CUT_OFF_V = 18.0
"""Below it the robot reports an error (UNDERVOLT_ERROR of clearpath_platform's A200 hardware)."""

LOW, VERY_LOW = 0.3, 0.2
"""Charges for a warning and for an error: LOWPOWER_WARN and LOWPOWER_ERROR of the same."""


def charge_at_rest(voltage_v: float) -> float:
    """Return the charge, from 0 to 1, at which a battery at rest has this voltage."""
    return _interpolated(voltage_v, OPEN_CIRCUIT_V, CHARGES)


def _interpolated(at: float, places: Sequence[float], values: Sequence[float]) -> float:
    """Interpolate as numpy.interp does, in a third of its time for one number."""
    right = min(max(bisect_right(places, at), 1), len(places) - 1)
    left = right - 1
    part = (at - places[left]) / (places[right] - places[left])
    return values[left] + min(max(part, 0.0), 1.0) * (values[right] - values[left])


class Battery:
    """
    A battery that is drawn from.

    :param charge: at the start, from 0 to 1.
    """

    def __init__(self, charge: float) -> None:
        self._start = charge
        self.reset()

    def reset(self) -> None:
        """Have the charge of the start again."""
        self.charge = self._start
        self.current_a = 0.0
        self._measure()

    def draw(self, power_w: float, period_sec: float) -> None:
        """Give power for a while; none when empty."""
        if self.is_empty:
            power_w = 0.0
        source_v, resistance_ohm = self._source_v, self._resistance_ohm
        # Of the two currents that give this power, the smaller: I (source - R I) = power.
        root_v = math.sqrt(max(source_v**2 - 4.0 * resistance_ohm * power_w, 0.0))
        self.current_a = (source_v - root_v) / (2.0 * resistance_ohm)
        used_ah = self.current_a * period_sec / 3600.0
        self.charge = max(self.charge - used_ah / CAPACITY_AH, 0.0)
        self._measure()

    def _measure(self) -> None:
        self._source_v = _interpolated(self.charge, CHARGES, OPEN_CIRCUIT_V)
        self._resistance_ohm = RESISTANCE_OHM * (2.0 - self.charge)
        self.voltage_v = self._source_v - self._resistance_ohm * self.current_a

    @property
    def is_empty(self) -> bool:
        """Whether nothing is left."""
        return self.charge <= 0.0

    @property
    def power_limit_w(self) -> float:
        """Return what may be drawn: no more than leaves the voltage above the cut-off."""
        left_v = self._source_v - CUT_OFF_V
        return min(POWER_W, CUT_OFF_V * left_v / self._resistance_ohm)
