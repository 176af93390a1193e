#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measure `ros2 topic list`, `ros2 node list` and `ros2 --help` beside a number of running nodes.

    ./lab exec python benchmark/graph_commands.py [--nodes 12] [--runs 50]

Prints for each command how many runs were complete, and the wall and CPU time of a whole process:
median and largest.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
import os
import resource
import signal
import statistics
import subprocess
import sys
import time

from husky_runtime.domains import in_own_domain

_NODE = """
import sys, rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
rclpy.init()
node = Node(sys.argv[1])
publisher = node.create_publisher(String, f'{sys.argv[1]}/text', 10)
node.create_subscription(String, 'shared', lambda _: None, 10)
node.create_timer(0.1, lambda: publisher.publish(String(data='x')))
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""
_START_SEC = 60.0


def main() -> int:
    """Run the benchmark; exit status 1 where a run was not complete."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--nodes', type=int, default=12)
    parser.add_argument('--runs', type=int, default=50)
    args = parser.parse_args()
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    names = [f'bench_{i:02}' for i in range(args.nodes)]
    nodes = {f'/{name}' for name in names}
    topics = {f'{name}/text' for name in nodes} | {'/shared', '/rosout', '/parameter_events'}
    complete = True
    with _running(names):
        _wait_for(nodes)
        complete &= _measure('ros2 node list', nodes, args.runs)
        complete &= _measure('ros2 topic list', topics, args.runs)
        _measure('ros2 --help', set(), args.runs)
    return 0 if complete else 1


@contextmanager
def _running(names: list[str]) -> Iterator[None]:
    processes = [subprocess.Popen([sys.executable, '-c', _NODE, name]) for name in names]
    try:
        yield
    finally:
        for process in processes:
            process.send_signal(signal.SIGINT)
        for process in processes:
            process.wait(10)


def _wait_for(nodes: set[str]) -> None:
    end = time.monotonic() + _START_SEC
    while missing := nodes - set(_run('ros2 node list')):
        if time.monotonic() > end:
            raise SystemExit(f'these nodes did not start: {", ".join(sorted(missing))}')


def _run(command: str) -> list[str]:
    words = [sys.executable, '-m', 'ros2cli', *command.split()[1:]]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()


def _measure(command: str, expected: set[str], runs: int) -> bool:
    walls, cpus, complete = [], [], 0
    for _ in range(runs):
        before, start = _children_cpu(), time.perf_counter()
        found = set(_run(command))
        walls.append(time.perf_counter() - start)
        cpus.append(_children_cpu() - before)
        complete += expected <= found
    print(
        f'{command:16} complete {complete}/{runs}  wall {statistics.median(walls):.2f} s '
        f'(largest {max(walls):.2f})  cpu {statistics.median(cpus):.2f} s '
        f'(largest {max(cpus):.2f})'
    )
    return complete == runs


def _children_cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


if __name__ == '__main__':
    with in_own_domain():
        sys.exit(main())
