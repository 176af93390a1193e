# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print what the simulator costs as a process: start, pace, CPU and memory.

The pacing error is how far each /clock message is from its due time when another process
receives it, so it includes the way there and whatever else the machine does. Beside it stands the
error of a bare sleep of 20 ms, in a third process at the same time: what the machine allows.

Run it with:  ./lab exec python benchmark/simulator_process.py [--seconds 60] [--hour]
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import contextlib
import gc
import math
import multiprocessing
import subprocess
import sys
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, Vector3
from husky_runtime.domains import in_own_domain
from nav_msgs.msg import Odometry
import numpy as np
import psutil
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

PERIOD_SEC = 0.02
MOVING_M_S = 0.4
START_LIMIT_SEC = 30.0


class TopicReader(Node):
    """Notes when the simulator says something, and what time it is there."""

    def __init__(self) -> None:
        super().__init__('benchmark_reader')
        self.odometry_at_sec = 0.0
        self.clock: list[tuple[float, float]] = []
        self.moving = self.nonfinite = 0
        self.warnings = 'unknown'
        self.create_subscription(Odometry, 'odometry/filtered', self._on_odometry, 10)
        self.create_subscription(Clock, '/clock', self._on_clock, 100)
        self.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)

    def _on_odometry(self, message: Odometry) -> None:
        self.odometry_at_sec = self.odometry_at_sec or time.monotonic()
        pose, twist = message.pose.pose, message.twist.twist
        self.moving += twist.linear.x > MOVING_M_S
        self.nonfinite += not math.isfinite(pose.position.x + pose.orientation.w + twist.linear.x)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        values = {pair.key: pair.value for pair in message.status[0].values}
        self.warnings = values['physics_warnings']

    def _on_clock(self, message: Clock) -> None:
        self.clock.append((time.monotonic(), message.clock.sec + message.clock.nanosec * 1e-9))


def started(**parameters: Any) -> psutil.Popen:
    """Start the simulator."""
    words = [word for name, value in parameters.items() for word in ('-p', f'{name}:={value}')]
    command = [sys.executable, '-m', 'husky_sim.ros.node', '--ros-args', *words]
    return psutil.Popen(command, stderr=subprocess.DEVNULL)


def stopped(process: psutil.Popen) -> None:
    """End it."""
    process.terminate()
    process.wait(timeout=10.0)


def cpu_sec(process: psutil.Popen) -> float:
    """Return the CPU time of a process so far."""
    used = process.cpu_times()
    return float(used.user + used.system)


def memory_mb(process: psutil.Popen) -> float:
    """Return the resident memory of a process."""
    return process.memory_info().rss / 2**20


@contextlib.contextmanager
def listening() -> Iterator[tuple[TopicReader, Any]]:
    """Yield a reader and the executor that costs least: the reader must not be what is late."""
    reader, executor = TopicReader(), EventsExecutor()
    executor.add_node(reader)
    gc.freeze()
    yield reader, executor
    executor.remove_node(reader)
    executor.shutdown()
    reader.destroy_node()


def spin_until(
    executor: Any, reader: TopicReader, deadline_sec: float, *, first: bool = False
) -> None:
    """Listen until a time, or until the first odometry message."""
    while time.monotonic() < deadline_sec and not (first and reader.odometry_at_sec):
        executor.spin_once(timeout_sec=0.05)


def sleep_bare(seconds: float, errors: Any) -> None:
    """Put the lateness of sleeps that end every 20 ms into a queue, in ms."""
    late = []
    due = time.monotonic()
    end = due + seconds
    while due < end:
        due += PERIOD_SEC
        time.sleep(max(due - time.monotonic(), 0.0))
        late.append(1000.0 * (time.monotonic() - due))
    errors.put(late)


def real_time(seconds: float) -> None:
    """Measure the start, and a run in real time."""
    spawn = multiprocessing.get_context('spawn')
    late: Any = spawn.Queue()
    sleeper = spawn.Process(target=sleep_bare, args=(seconds, late), daemon=True)
    with listening() as (reader, executor):
        begin = time.monotonic()
        process = started()
        spin_until(executor, reader, begin + START_LIMIT_SEC, first=True)
        print(f'start to first odometry     {reader.odometry_at_sec - begin:8.2f} s')
        sleeper.start()
        spin_until(executor, reader, time.monotonic() + 2.0)
        reader.clock.clear()
        used, begin = cpu_sec(process), time.monotonic()
        spin_until(executor, reader, begin + seconds)
        share = (cpu_sec(process) - used) / (time.monotonic() - begin)
        print(f'CPU in real time            {share:8.1%}')
        times = np.array(reader.clock)
        print(f'memory                      {memory_mb(process):8.0f} MB')
        stopped(process)
    errors = times[:, 0] - times[:, 1]
    errors = 1000.0 * np.abs(errors - np.median(errors))
    print(f'{"pacing error, ms":<20} {"median":>8} {"99 %":>8} {"largest":>8}')
    for name, values in (('/clock', errors), ('bare sleep', np.array(late.get()))):
        middle, most = np.percentile(values, (50, 99))
        print(f'{name:<20} {middle:>8.2f} {most:>8.2f} {values.max():>8.2f}')
    sleeper.join()


def an_hour() -> None:
    """Drive in a circle for an hour of simulated time, and watch the memory and the physics."""
    with listening() as (reader, executor):
        process = started(real_time_factor=0.0, command_timeout_sec=60.0)
        publisher = reader.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
        circle = Twist(linear=Vector3(x=0.5), angular=Vector3(z=-0.5))
        reader.create_timer(0.1, lambda: publisher.publish(circle))
        memory = []
        for quarter in range(1, 5):
            while not reader.clock or reader.clock[-1][1] < 900.0 * quarter:
                reader.clock = reader.clock[-1:]
                executor.spin_once(timeout_sec=0.05)
            memory.append(f'{memory_mb(process):.0f}')
        print(f'memory after each 15 min    {", ".join(memory)} MB')
        print(f'odometry moving, not finite {reader.moving}, {reader.nonfinite}')
        print(f'warnings of the physics     {reader.warnings}')
        stopped(process)


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
    with in_own_domain():
        main()
