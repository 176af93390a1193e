# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is told on /diagnostics once a second of wall time: pace, and batteries."""

from collections.abc import Iterable
import time

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.robot.battery import Battery, LOW, VERY_LOW
from husky_sim.ros.pacing import Pacer
from husky_sim.simulation import SimulatedRobot, Simulation

PERIOD_SEC = 1.0
_ENOUGH = 0.95  # of the requested pace


class PaceWatch:
    """Compares simulated with wall time, from one call to the next."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._overruns = 0
        self.restart()
        self._is_judged = True

    def restart(self) -> None:
        """
        Measure from now on, after a reset, a pause or a change of pace.

        What the next call measures is no full interval, and is not judged.
        """
        self._wall_sec = time.monotonic()
        self._time_sec = self._simulation.time_sec
        self._is_judged = False

    def status(self, pacer: Pacer, asked: float, *, waits: bool) -> DiagnosticStatus:
        """
        Return the status of the time since the last call, or restart.

        :param asked: the real-time factor, 0 for as fast as possible.
        :param waits: whether a pause or a driver, and not the machine, delays time.
        """
        now_sec, time_sec = time.monotonic(), self._simulation.time_sec
        passed_sec, wall_sec = time_sec - self._time_sec, max(now_sec - self._wall_sec, 1e-9)
        factor = passed_sec / wall_sec
        # Time passes by whole control periods: one may be due just after the interval.
        lacks = passed_sec + CONTROL_PERIOD_SEC < _ENOUGH * asked * wall_sec
        late = lacks or pacer.overruns > self._overruns
        too_slow = self._is_judged and not waits and asked > 0.0 and late
        self._wall_sec, self._time_sec, self._overruns = now_sec, time_sec, pacer.overruns
        self._is_judged = True
        warnings = self._simulation.physics_warnings
        level, message = DiagnosticStatus.OK, f'{factor:.2f} x real time'
        if warnings:
            level = DiagnosticStatus.ERROR
            message = (
                f'{message}; the physics warned {warnings} times: the run is not to be trusted'
            )
        elif too_slow:
            level = DiagnosticStatus.WARN
            message = f'{message} of {asked:g} asked for: this machine is too slow or too busy'
        values = {
            'real_time_factor': f'{factor:.3f}',
            'real_time_factor_asked': f'{asked:g}',
            'overruns': str(pacer.overruns),
            'wall_time_lost_sec': f'{pacer.lost_sec:.3f}',
            'physics_warnings': str(warnings),
            'sim_time_sec': f'{time_sec:.2f}',
        }
        return DiagnosticStatus(
            level=level,
            name='husky_sim: time',
            message=message,
            hardware_id='husky_sim',
            values=_values(values),
        )


def battery_statuses(robots: Iterable[SimulatedRobot]) -> list[DiagnosticStatus]:
    """Return how full each battery is, of those robots that have one."""
    return [
        _battery_status(robot.name, robot.battery) for robot in robots if robot.battery is not None
    ]


def _battery_status(robot: str, battery: Battery) -> DiagnosticStatus:
    level = DiagnosticStatus.OK
    message = f'{battery.voltage_v:.1f} V, {100.0 * battery.charge:.0f} % charged'
    if battery.charge < LOW:
        level = DiagnosticStatus.ERROR if battery.charge < VERY_LOW else DiagnosticStatus.WARN
        empty = 'empty: the motors are off until a reset'
        message = f'{message}; {empty if battery.is_empty else "low"}'
    values = {
        'voltage_v': f'{battery.voltage_v:.2f}',
        'current_a': f'{battery.current_a:.2f}',
        'charge': f'{battery.charge:.4f}',
        'power_limit_w': f'{battery.power_limit_w:.0f}',
    }
    return DiagnosticStatus(
        level=level,
        name=f'husky_sim: battery of {robot}',
        message=message,
        hardware_id=robot,
        values=_values(values),
    )


def _values(values: dict[str, str]) -> list[KeyValue]:
    return [KeyValue(key=key, value=value) for key, value in values.items()]
