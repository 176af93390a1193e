# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print what the simulator costs as a process: start, pace, CPU and memory.

The pacing error is that of /clock as another process receives it, so it includes the way there
and whatever else the machine does.

Run it with:  ./lab exec python benchmark/simulator_process.py [--seconds 60] [--hour]
"""

from __future__ import annotations

import argparse
from pathlib import Path
import subprocess
import sys
import time
from typing import Any

from nav_msgs.msg import Odometry
import numpy as np
import rclpy
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

START_LIMIT_SEC = 30.0


class Ear(Node):
    """Notes when the simulator says something, and what time it is there."""

    def __init__(self) -> None:
        super().__init__('benchmark_ear')
        self.odometry_at_sec = 0.0
        self.clock: list[tuple[float, float]] = []
        self.create_subscription(Odometry, 'odometry/filtered', self._on_odometry, 10)
        self.create_subscription(Clock, '/clock', self._on_clock, 100)

    def _on_odometry(self, _: Odometry) -> None:
        self.odometry_at_sec = self.odometry_at_sec or time.monotonic()

    def _on_clock(self, message: Clock) -> None:
        self.clock.append((time.monotonic(), message.clock.sec + message.clock.nanosec * 1e-9))


def started(**parameters: Any) -> subprocess.Popen[bytes]:
    """Start the simulator."""
    words = [word for name, value in parameters.items() for word in ('-p', f'{name}:={value}')]
    command = [sys.executable, '-m', 'husky_sim.node', '--ros-args', *words]
    return subprocess.Popen(command, stderr=subprocess.DEVNULL)


def stopped(process: subprocess.Popen[bytes]) -> None:
    """End it."""
    process.terminate()
    process.wait(timeout=10.0)


def cpu_sec(process: subprocess.Popen[bytes]) -> float:
    """Return the CPU time of a process so far."""
    fields = Path(f'/proc/{process.pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def memory_mb(process: subprocess.Popen[bytes]) -> float:
    """Return the resident memory of a process."""
    status = Path(f'/proc/{process.pid}/status').read_text()
    return int(status.partition('VmRSS:')[2].split()[0]) / 1024.0


def spin_until(ear: Ear, deadline_sec: float, *, first: bool = False) -> None:
    """Listen until a time, or until the first odometry message."""
    while time.monotonic() < deadline_sec and not (first and ear.odometry_at_sec):
        rclpy.spin_once(ear, timeout_sec=0.05)


def real_time(seconds: float) -> None:
    """Measure the start, and a run in real time."""
    ear = Ear()
    begin = time.monotonic()
    process = started()
    spin_until(ear, begin + START_LIMIT_SEC, first=True)
    print(f'start to first odometry     {ear.odometry_at_sec - begin:8.2f} s')
    spin_until(ear, time.monotonic() + 2.0)
    ear.clock.clear()
    used, begin = cpu_sec(process), time.monotonic()
    spin_until(ear, begin + seconds)
    share = (cpu_sec(process) - used) / (time.monotonic() - begin)
    print(f'CPU in real time            {share:8.1%}')
    times = np.array(ear.clock)
    errors = (times[:, 0] - times[0, 0]) - (times[:, 1] - times[0, 1])
    errors = 1000.0 * np.abs(errors - np.median(errors))
    print(f'pacing error, median        {np.percentile(errors, 50):8.2f} ms')
    print(f'pacing error, 99 %          {np.percentile(errors, 99):8.2f} ms')
    print(f'memory                      {memory_mb(process):8.0f} MB')
    stopped(process)
    ear.destroy_node()


def an_hour() -> None:
    """Run an hour of simulated time as fast as possible, and watch the memory."""
    ear = Ear()
    process = started(real_time_factor=0.0)
    memory = []
    for quarter in range(1, 5):
        while not ear.clock or ear.clock[-1][1] < 900.0 * quarter:
            ear.clock = ear.clock[-1:]
            rclpy.spin_once(ear, timeout_sec=0.05)
        memory.append(f'{memory_mb(process):.0f}')
    print(f'memory after each 15 min    {", ".join(memory)} MB')
    stopped(process)
    ear.destroy_node()


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=60.0, help='of the run in real time')
    parser.add_argument('--hour', action='store_true', help='also a simulated hour, for memory')
    given = parser.parse_args()
    rclpy.init()
    real_time(given.seconds)
    if given.hour:
        an_hour()
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
