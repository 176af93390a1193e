# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What the view costs the simulation, and how quick it is.

Prints: start of the view to its first page, updates a second that one tab gets, and, each without
and with the view and one tab: the pacing error in real time and the speed as fast as possible,
by the wall's clock and by the time that the simulator had a processor. The latter is what the view
costs the simulator itself, whatever else the machine does.
Runs without and with it alternate, so that what else the machine does hits both.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
import os
import signal
import statistics
import subprocess
import sys
import threading
import time
import urllib.request

from husky_runtime.domains import in_own_domain
from husky_sim.ros.node import SimulatorNode
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rclpy.task import Future
import viser
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from husky_sim.config import CONTROL_PERIOD_SEC

PORT = 18880
VIEW = ('ros2', 'run', 'husky_view', 'view', '--ros-args', '-p', f'viewer_port:={PORT}')


def open_tab(address: str) -> subprocess.Popen[str]:
    """
    Start to read what a page gets, without a browser's own cost.

    It is a process of its own, as a browser is: a thread would take time from the simulator here.
    """
    command = [sys.executable, __file__, '--tab', address]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def read_as_tab(address: str) -> None:
    """Read until standard input ends, then print how many messages came a second."""
    count = 0
    begun = time.monotonic() + 2.0  # by then it has the scene, and only what changes still comes

    def read(socket: ClientConnection) -> None:
        nonlocal count
        for _ in socket:
            count += time.monotonic() > begun

    with connect(
        address.replace('http', 'ws').rstrip('/'),
        subprotocols=[Subprotocol(f'viser-v{viser.__version__}')],
        max_size=None,
    ) as socket:
        threading.Thread(target=read, args=(socket,), daemon=True).start()
        sys.stdin.read()
        print(count / (time.monotonic() - begun), flush=True)
    sys.exit()


@contextmanager
def view() -> Iterator[tuple[float, subprocess.Popen[str]]]:
    """Start the view; yield the seconds to its page and a tab that shows it."""
    begun = time.monotonic()
    with subprocess.Popen(
        VIEW, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as child:
        assert child.stdout is not None
        line = next(line for line in child.stdout if 'look at' in line)
        address = line.split('look at ')[1].strip()
        with urllib.request.urlopen(address, timeout=10.0) as page:
            page.read()
        ready_sec = time.monotonic() - begun
        tab = open_tab(address)
        try:
            yield ready_sec, tab
        finally:
            os.killpg(child.pid, signal.SIGINT)


Moment = tuple[float, float]  # of the wall's clock, and processor time of this process, s


class Measured(SimulatorNode):
    """Notes when each control period began, and ends after some seconds."""

    def __init__(self, factor: float, seconds: float, finished: Future[None]) -> None:
        super().__init__(parameter_overrides=[Parameter('real_time_factor', value=factor)])
        self.begun: list[Moment] = []
        self._finished = finished
        self._end_sec = time.perf_counter() + seconds

    def advance(self, *, tells_time: bool = True) -> None:
        self.begun.append((time.perf_counter(), time.process_time()))
        super().advance(tells_time=tells_time)
        if self.begun[-1][0] > self._end_sec and not self._finished.done():
            self._finished.set_result(None)


def run(factor: float, seconds: float) -> list[Moment]:
    """Simulate for so long, after a second to begin with; return when the periods began."""
    rclpy.init()
    executor = EventsExecutor()
    finished: Future[None] = Future(executor=executor)
    node = Measured(factor, seconds + 1.0, finished)
    try:
        executor.add_node(node)
        executor.spin_until_future_complete(finished, timeout_sec=seconds + 30.0)
        executor.remove_node(node)
        return [at for at in node.begun if at[0] > node.begun[0][0] + 1.0]
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def pacing_p99_ms(begun: list[Moment]) -> float:
    """Return how late the latest hundredth of the periods began, against an even beat."""
    first = begun[0][0]
    late = [at - first - place * CONTROL_PERIOD_SEC for place, (at, _) in enumerate(begun)]
    middle = statistics.median(late)
    return 1000.0 * sorted(abs(value - middle) for value in late)[int(len(late) * 0.99)]


def times_real(begun: list[Moment]) -> float:
    return (len(begun) - 1) * CONTROL_PERIOD_SEC / (begun[-1][0] - begun[0][0])


def times_real_alone(begun: list[Moment]) -> float:
    return (len(begun) - 1) * CONTROL_PERIOD_SEC / (begun[-1][1] - begun[0][1])


MEASURES: tuple[tuple[float, str, Callable[[list[Moment]], float]], ...] = (
    (1.0, 'pacing error p99, ms', pacing_p99_ms),
    (0.0, 'as fast as possible, x real time', times_real),
    (0.0, '... by processor time', times_real_alone),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=8.0, help='of each run')
    parser.add_argument('--rounds', type=int, default=3)
    parser.add_argument('--tab', help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.tab:
        read_as_tab(options.tab)
    figures: dict[tuple[str, str], list[float]] = {}
    for _ in range(options.rounds):
        for factor in (1.0, 0.0):
            alone = run(factor, options.seconds)
            seen, updates, ready_sec = watched_run(factor, options.seconds)
            for of_factor, name, measure in MEASURES:
                if of_factor == factor:
                    figures.setdefault((name, 'without'), []).append(measure(alone))
                    figures.setdefault((name, 'with a tab'), []).append(measure(seen))
            figures.setdefault(('updates a second', f'factor {factor:g}'), []).append(updates)
            figures.setdefault(('start to page, s', ''), []).append(ready_sec)
    for (name, how), values in sorted(figures.items()):
        listed = ' '.join(f'{value:.2f}' for value in values)
        print(f'{name:34} {how:12} median {statistics.median(values):8.2f}   ({listed})')
    print(f'load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors', file=sys.stderr)


def watched_run(factor: float, seconds: float) -> tuple[list[Moment], float, float]:
    """Run with a view and a tab; return also the updates a second and the start-up time."""
    found: dict[str, float] = {}
    done = threading.Event()

    def look() -> None:
        with view() as (ready_sec, tab):
            found['ready'] = ready_sec
            done.wait(seconds * 3)
            found['updates'] = float(tab.communicate('end')[0])

    looker = threading.Thread(target=look)
    looker.start()
    begun = run(factor, seconds + 4.0)
    done.set()
    looker.join(20.0)
    # the view takes its time to start: only what came after counts
    return [at for at in begun if at[0] > begun[0][0] + 4.0], found['updates'], found['ready']


if __name__ == '__main__':
    with in_own_domain():
        main()
