#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let processes make nodes and end them, again and again, and count the ends that hang.

    ./lab exec python benchmark/node_ends.py [--processes 6] [--seconds 400]

Each node has five publishers and five subscriptions, and a participant of its own. So most of them
end while others are just being discovered, which hung in some of a thousand ends; see
underlay/mended_calls.py.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path
import select
import subprocess
import sys
import time

from husky_runtime.domains import in_own_domain

_NODES = """
import random, time
import rclpy
from std_msgs.msg import Empty

while True:
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('ends', context=context)
    for number in range(5):
        node.create_publisher(Empty, f'topic_{number}', 10)
        node.create_subscription(Empty, f'topic_{number}', print, 10)
    time.sleep(random.uniform(0.0, 0.15))
    node.destroy_node()
    rclpy.shutdown(context=context)
    print('ended', flush=True)
"""
_HANGS_SEC = 10.0  # an end takes 0.2 s here


class _Process:
    """One that ends nodes, and what is known of it."""

    def __init__(self) -> None:
        self.ends = self.hung = self.died = 0
        self._last_sec = time.monotonic()
        self._process = _start()

    def look(self) -> None:
        """Count what it says; start another one where it hangs or has died."""
        said = self._process.stdout
        assert said is not None
        if select.select([said], [], [], 0.0)[0]:
            told = os.read(said.fileno(), 4096)
            self._last_sec = time.monotonic()
            self.ends += told.count(b'\n')
            if not told:
                self.died += 1
                self._start_again()
        elif time.monotonic() - self._last_sec > _HANGS_SEC:
            self.hung += 1
            cpu_ticks = sum(map(int, self._status()[11:13]))
            print(f'hangs, after {cpu_ticks / os.sysconf("SC_CLK_TCK"):.1f} s of CPU', flush=True)
            self._start_again()

    def stop(self) -> None:
        self._process.kill()
        self._process.communicate()

    def _start_again(self) -> None:
        self.stop()
        self._last_sec = time.monotonic()
        self._process = _start()

    def _status(self) -> list[str]:
        text = Path(f'/proc/{self._process.pid}/stat').read_text(encoding='utf-8')
        return text.rpartition(')')[2].split()


def _start() -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, '-c', _NODES], stdout=subprocess.PIPE)


def main() -> int:
    """Run the benchmark; exit status 1 where an end hung or a process died."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--processes', type=int, default=6)
    parser.add_argument('--seconds', type=float, default=400.0)
    args = parser.parse_args()
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    processes = [_Process() for _ in range(args.processes)]
    end_sec = time.monotonic() + args.seconds
    try:
        while time.monotonic() < end_sec:
            for process in processes:
                process.look()
            time.sleep(0.1)
    finally:
        for process in processes:
            process.stop()
    ends, hung, died = (
        sum(getattr(process, name) for process in processes) for name in ('ends', 'hung', 'died')
    )
    print(f'{ends} ends, {hung} hung, {died} processes died')
    return 1 if hung or died else 0


if __name__ == '__main__':
    with in_own_domain():
        sys.exit(main())
