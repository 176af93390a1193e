# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The two motors of an A200, one a side, and the battery that feeds them.

A brushed DC motor: its torque follows its current, its speed takes voltage, and the rest of the
voltage is lost in the winding. So a motor is the weaker the faster it turns and the lower the
voltage is. Speeds and torques are those of the two wheels of a side, behind the gear.

Motor and gear: McCormick, Lang and de Silva, Dynamic Modeling and Simulation of a Four-wheel
Skid-Steer Mobile Robot (arXiv 2110.00323), as a work that builds on it quotes them. They agree
with the manual: at 24 V such a motor drives 1.13 m/s without load, and the manual has 1 m/s.
"""

import math

from husky_sim.robot.battery import Battery
from husky_sim.robot.husky import Husky, TorqueRange

TORQUE_N_M_A = 0.0445 * 78.71
"""Torque of the wheels an ampere, and volts a rad/s: motor constant times gear."""
RESISTANCE_OHM = 0.46

FRICTION_N_M = 1.5 * TORQUE_N_M_A
"""Of gear, chains and rolling tyres: what takes 1.5 A without load, which is a choice."""
SLOW_RAD_S = 0.05
"""Below it friction fades out, so that a robot at rest draws nothing for it; a choice."""

IDLE_W = 60.0
"""Computer and electronics: 20 Ah at 24 V last for the manual's 8 h of standby."""


def current_limit_a(speed_rad_s: float, *, supply_v: float, power_w: float) -> float:
    """
    Return the greatest current of a motor, in the direction in which speed is positive.

    :param speed_rad_s: negative: the current brakes.
    :param power_w: what the motor may draw.
    """
    induced_v = TORQUE_N_M_A * speed_rad_s
    by_voltage_a = (supply_v - induced_v) / RESISTANCE_OHM
    # I (R I + induced) = power
    root_v = math.sqrt(induced_v**2 + 4.0 * RESISTANCE_OHM * power_w)
    return min(by_voltage_a, (root_v - induced_v) / (2.0 * RESISTANCE_OHM))


def torque_range_n_m(speed_rad_s: float, *, supply_v: float, power_w: float) -> TorqueRange:
    """Return the least and the greatest torque that the wheels of a side can have."""
    forward_a = current_limit_a(speed_rad_s, supply_v=supply_v, power_w=power_w)
    backward_a = current_limit_a(-speed_rad_s, supply_v=supply_v, power_w=power_w)
    friction_n_m = _friction_n_m(speed_rad_s)
    return (
        -backward_a * TORQUE_N_M_A - friction_n_m,
        forward_a * TORQUE_N_M_A - friction_n_m,
    )


def electrical_power_w(torque_n_m: float, speed_rad_s: float) -> float:
    """Return what a motor draws; what it would give back in braking becomes heat, a choice."""
    current_a = (torque_n_m + _friction_n_m(speed_rad_s)) / TORQUE_N_M_A
    voltage_v = RESISTANCE_OHM * current_a + TORQUE_N_M_A * speed_rad_s
    return max(voltage_v * current_a, 0.0)


def _friction_n_m(speed_rad_s: float) -> float:
    return FRICTION_N_M * max(-1.0, min(1.0, speed_rad_s / SLOW_RAD_S))


class Motors:
    """
    Drives the wheels of a robot as far as its battery lets it, in every physics step.

    A step is short enough to go by the voltage of the last one; a control period is not: a wheel
    that runs free would be far beyond its power before the next.
    """

    def __init__(self, husky: Husky, battery: Battery) -> None:
        self._husky, self.battery = husky, battery
        self.reset()

    def reset(self) -> None:
        """Have the battery of the start again; the physics must have been reset before."""
        self.battery.reset()
        self._limit()

    def drive(self, left_rad_s: float, right_rad_s: float) -> None:
        """Aim at these speeds; with an empty battery, at standing still."""
        if self.battery.is_empty:
            left_rad_s = right_rad_s = 0.0
        self._husky.drive(left_rad_s, right_rad_s)

    def step(self, step_sec: float) -> None:
        """Take from the battery what a step has used, and see what is left for the next."""
        torques_n_m = self._husky.wheels().side_torques_n_m
        motors_w = math.fsum(map(electrical_power_w, torques_n_m, self._speeds_rad_s))
        self.battery.draw(motors_w + IDLE_W, step_sec)
        self._limit()

    def _limit(self) -> None:
        battery = self.battery
        self._speeds_rad_s = self._husky.wheels().side_speeds_rad_s
        if battery.is_empty:
            only_friction = (-FRICTION_N_M, FRICTION_N_M)
            self._husky.limit(only_friction, only_friction)
            return
        supply_v, power_w = battery.voltage_v, (battery.power_limit_w - IDLE_W) / 2.0
        left, right = (
            torque_range_n_m(speed, supply_v=supply_v, power_w=power_w)
            for speed in self._speeds_rad_s
        )
        self._husky.limit(left, right)
