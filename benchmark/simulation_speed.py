# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how fast the simulator is beside bare mj_step of the same model, in the same minute.

Every figure is a real-time factor: simulated seconds a second. Each row is measured in a process
of its own (speed_row.py). With another clone given, its rows are measured in turn with this one's
(A B, B A, ...), and the ratio printed is the median of those of the pairs: by the wall clock, and
by the CPU time of the simulator's process, which a busy machine changes less. Exit status 1 if a
ratio by CPU time is below 0.95.

With --filter it prints what the inverse of the filter behind odometry/filtered costs, by
cofactors as it is and by numpy.linalg.solve, and what of it is left in the simulated speed.

Run it with:  ./lab exec python benchmark/simulation_speed.py [--seconds 5 | --filter]
              ./lab exec python benchmark/simulation_speed.py --beside ../other_clone [--pairs 9]
"""

from __future__ import annotations

import argparse
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
import json
import os
from pathlib import Path
import signal
from statistics import median
import subprocess
import sys
import time
from typing import Any

from husky_course.frames import Array
from husky_runtime.domains import in_own_domain
from husky_sim.sensors.localization import PlanarFilter, RATE, VX, WHEEL_SPEED_VARIANCE
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC, SimulationConfig

ROOT = Path(__file__).resolve().parent.parent
LEAST_RATIO = 0.95
HEAD = f'{"simulator node":<24} {"robots":>6}'


@dataclass(frozen=True)
class Row:
    """
    What is measured.

    :param reads: whether somebody reads every topic.
    :param parameters: of the simulator's node.
    """

    name: str
    robots: int = 1
    reads: bool = True
    parameters: dict[str, Any] = field(default_factory=dict)


ROWS = (
    Row('free running'),
    Row('nobody reads', reads=False),
    Row('with lidar at 10 Hz', parameters={'lidar_rate_hz': 10.0}),
    Row('lockstep with a driver', reads=False, parameters={'lockstep': True}),
    Row('free running', robots=3),
    Row('free running', robots=10),
)


def measure(clone: Path, row: Row, seconds: float, *options: str) -> dict[str, Any]:
    """Return what speed_row.py prints of the simulator of a clone."""
    script = Path(__file__).resolve().with_name('speed_row.py')
    command = [str(clone / 'lab'), 'exec', 'python3', str(script), f'--robots={row.robots}']
    command += [f'--parameters={json.dumps(row.parameters)}', f'--seconds={seconds}', *options]
    if not row.reads:
        command.append('--without-readers')
    # In a group of its own: Ctrl-C reaches only us, and we end all of it.
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
    try:
        printed, _ = process.communicate()
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        process.wait()
    if process.returncode:
        raise SystemExit(f'{row.name}: not measured in {clone}; what it said stands above')
    figures: dict[str, Any] = json.loads(printed)
    if not Path(figures['package']).is_relative_to(clone):
        raise SystemExit(f'{clone}: the simulator of {figures["package"]} ran; use a new terminal')
    return figures


def print_table(seconds: float) -> None:
    """Measure every row once."""
    print(f'{HEAD} {"x real time":>12} {"bare mj_step":>13} {"part":>6}')
    for row in ROWS:
        measured = measure(ROOT, row, seconds)
        factor, bare = measured['factor'], measured['bare']
        print(f'{title(row)} {factor:>12.1f} {bare:>13.1f} {factor / bare:>6.0%}', flush=True)


def print_pairs(other: Path, seconds: float, pairs: int) -> int:
    """Measure every row in both clones in turn; return how many are slower here."""
    slower = 0
    print(f'{HEAD} {"here":>8} {"there":>8} {"by wall":>8} {"by CPU":>8}   all ratios by CPU')
    for row in ROWS:
        here: list[dict[str, Any]] = []
        there: list[dict[str, Any]] = []
        for number in range(pairs):
            turn = [(ROOT, here), (other, there)]
            for clone, measured in turn if number % 2 == 0 else turn[::-1]:
                measured.append(measure(clone, row, seconds, '--without-bare'))
        by_wall, by_cpu = ratios(here, there, 'factor'), ratios(here, there, 'cpu_factor')
        slower += median(by_cpu) < LEAST_RATIO
        medians = [median(each['factor'] for each in measured) for measured in (here, there)]
        print(
            f'{title(row)} {medians[0]:>8.1f} {medians[1]:>8.1f} {median(by_wall):>8.3f} '
            f'{median(by_cpu):>8.3f}   {" ".join(f"{ratio:.2f}" for ratio in by_cpu)}',
            flush=True,
        )
    return slower


def ratios(here: list[dict[str, Any]], there: list[dict[str, Any]], name: str) -> list[float]:
    return sorted(one[name] / other[name] for one, other in zip(here, there, strict=True))


def title(row: Row) -> str:
    return f'{row.name:<24} {row.robots:>6}'


class SolvedFilter(PlanarFilter):
    """The filter with LAPACK in the place of cofactors."""

    def _gain(self) -> Array:
        seen = self._seen
        variances = (WHEEL_SPEED_VARIANCE, WHEEL_SPEED_VARIANCE, self._rate_variance)
        covariance = seen[:, VX : RATE + 1] + np.diag(variances)
        return np.asarray(np.linalg.solve(covariance, seen), dtype=np.float64)


def print_filters(rounds: int = 15, periods: int = 500) -> None:
    """Measure the CPU time of both filters in turn: alone, and in a whole simulation."""
    world = str(default_worlds() / 'playpen.xml')
    simulation = Simulation(SimulationConfig(world=world))
    (robot,) = simulation.robots
    took: dict[str, dict[type[PlanarFilter], list[float]]] = {'update': {}, 'control period': {}}
    for number in range(rounds):
        kinds = (PlanarFilter, SolvedFilter)
        for kind in kinds if number % 2 == 0 else kinds[::-1]:
            simulation.reset()
            robot.filtered = kind(CONTROL_PERIOD_SEC)
            update = partial(
                robot.filtered.update,
                wheel_speed_m_s=0.5, wheel_yaw_rate_rad_s=0.1,
                imu_yaw=0.0, imu_yaw_rate_rad_s=0.1,
            )  # fmt: skip
            for name, function in (('update', update), ('control period', simulation.advance)):
                begin_sec = time.process_time()
                for _ in range(periods):
                    function()
                passed_us = (time.process_time() - begin_sec) / periods * 1e6
                took[name].setdefault(kind, []).append(passed_us)
    print(f'{"median, us":<16} {"cofactors":>10} {"solve":>8} {"ratio":>6}')
    for name, figures in took.items():
        ours, solved = (median(figures[kind]) for kind in (PlanarFilter, SolvedFilter))
        print(f'{name:<16} {ours:>10.1f} {solved:>8.1f} {solved / ours:>6.2f}')


def main() -> int:
    """Print the table, the pairs, or the filters."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument('--seconds', type=float, default=5.0, help='of every measurement')
    parser.add_argument('--beside', type=Path, help='another clone of the lab')
    parser.add_argument('--pairs', type=int, default=9, help='of measurements of every row')
    parser.add_argument('--filter', action='store_true', help='the inverse in the filter alone')
    given = parser.parse_args()
    if given.filter:
        print_filters()
        return 0
    if given.beside is not None and not (given.beside / 'lab').is_file():
        parser.error(f'--beside {given.beside}: no clone of the lab; name a folder that has ./lab')
    if given.pairs < 1 or not given.seconds > 0.0:
        parser.error('--pairs is 1 or more, --seconds more than 0')
    try:
        if given.beside is None:
            print_table(given.seconds)
            return 0
        return min(print_pairs(given.beside.resolve(), given.seconds, given.pairs), 1)
    except KeyboardInterrupt:
        return 130


if __name__ == '__main__':
    with in_own_domain():
        sys.exit(main())
