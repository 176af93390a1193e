# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What the view costs the simulation, and how quick it is.

Prints: start of the view to its first page, updates a second that one tab gets, and, each without
and with the view and one tab: the pacing error in real time and the speed as fast as possible.
Runs without and with it alternate, so that what else the machine does hits both.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
import os
import signal
import statistics
import subprocess
import sys
import threading
import time
import urllib.request

from husky_sim.node import SimulatorNode
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rclpy.task import Future
import viser
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from husky_sim.config import CONTROL_PERIOD_SEC

PORT = 18880
VIEW = ('ros2', 'run', 'husky_sim', 'view', '--ros-args', '-p', f'viewer_port:={PORT}')


class Tab:
    """Reads what a page gets, without a browser's own cost."""

    def __init__(self, port: int) -> None:
        self.messages = 0
        self._socket = connect(
            f'ws://127.0.0.1:{port}',
            subprotocols=[Subprotocol(f'viser-v{viser.__version__}')],
            max_size=None,
        )
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for _ in self._socket:
            self.messages += 1

    def close(self) -> None:
        self._socket.close()


@contextmanager
def view() -> Iterator[tuple[float, Tab]]:
    """Start the view; yield the seconds to its page and a tab that shows it."""
    begun = time.monotonic()
    with subprocess.Popen(
        VIEW, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as child:
        assert child.stderr is not None
        line = next(line for line in child.stderr if 'look at' in line)
        port = int(line.strip().rsplit(':', 1)[1])
        with urllib.request.urlopen(f'http://127.0.0.1:{port}/', timeout=10.0) as page:
            page.read()
        ready_sec = time.monotonic() - begun
        tab = Tab(port)
        try:
            yield ready_sec, tab
        finally:
            tab.close()
            os.killpg(child.pid, signal.SIGINT)


class Measured(SimulatorNode):
    """Notes when each control period began, and ends after some seconds."""

    def __init__(self, factor: float, seconds: float, finished: Future[None]) -> None:
        super().__init__(parameter_overrides=[Parameter('real_time_factor', value=factor)])
        self.begun: list[float] = []
        self._finished = finished
        self._end_sec = time.perf_counter() + seconds

    def _advance(self) -> None:
        self.begun.append(time.perf_counter())
        super()._advance()
        if self.begun[-1] > self._end_sec and not self._finished.done():
            self._finished.set_result(None)


def run(factor: float, seconds: float) -> list[float]:
    """Simulate for so long, after a second to begin with; return when the periods began."""
    rclpy.init()
    executor = EventsExecutor()
    finished: Future[None] = Future(executor=executor)
    node = Measured(factor, seconds + 1.0, finished)
    try:
        executor.add_node(node)
        executor.spin_until_future_complete(finished, timeout_sec=seconds + 30.0)
        executor.remove_node(node)
        return [at for at in node.begun if at > node.begun[0] + 1.0]
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def pacing_p99_ms(begun: list[float]) -> float:
    """Return how late the latest hundredth of the periods began, against an even beat."""
    late = [at - begun[0] - place * CONTROL_PERIOD_SEC for place, at in enumerate(begun)]
    middle = statistics.median(late)
    return 1000.0 * sorted(abs(value - middle) for value in late)[int(len(late) * 0.99)]


def times_real(begun: list[float]) -> float:
    return (len(begun) - 1) * CONTROL_PERIOD_SEC / (begun[-1] - begun[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=8.0, help='of each run')
    parser.add_argument('--rounds', type=int, default=3)
    options = parser.parse_args()
    figures: dict[tuple[str, str], list[float]] = {}
    for _ in range(options.rounds):
        for name, factor, measure in (
            ('pacing error p99, ms', 1.0, pacing_p99_ms),
            ('as fast as possible, x real time', 0.0, times_real),
        ):
            alone = measure(run(factor, options.seconds))
            figures.setdefault((name, 'without'), []).append(alone)
            seen, updates, ready_sec = watched_run(factor, options.seconds)
            figures.setdefault((name, 'with a tab'), []).append(measure(seen))
            figures.setdefault(('updates a second', name), []).append(updates)
            figures.setdefault(('start to page, s', ''), []).append(ready_sec)
    for (name, how), values in sorted(figures.items()):
        listed = ' '.join(f'{value:.2f}' for value in values)
        print(f'{name:34} {how:34} median {statistics.median(values):8.2f}   ({listed})')
    print(f'load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors', file=sys.stderr)


def watched_run(factor: float, seconds: float) -> tuple[list[float], float, float]:
    """Run with a view and a tab; return also the updates a second and the start-up time."""
    found: dict[str, float] = {}
    done = threading.Event()

    def look() -> None:
        with view() as (ready_sec, tab):
            found['ready'] = ready_sec
            time.sleep(1.0)
            before, begun = tab.messages, time.monotonic()
            done.wait(seconds * 3)
            found['updates'] = (tab.messages - before) / (time.monotonic() - begun)

    looker = threading.Thread(target=look)
    looker.start()
    begun = run(factor, seconds + 4.0)
    done.set()
    looker.join(20.0)
    # the view takes its time to start: only what came after counts
    return [at for at in begun if at > begun[0] + 4.0], found['updates'], found['ready']


if __name__ == '__main__':
    main()
