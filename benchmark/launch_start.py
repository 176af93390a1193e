#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measure how soon `ros2 launch` has ten nodes running, beside starting them by hand.

    ./lab exec python benchmark/launch_start.py [--nodes 10] [--runs 5]

A node runs when its constructor has returned. Prints the seconds from the start to the last node,
alternately by hand (all processes side by side) and by `ros2 launch`, their medians, the
difference of the best ones (what else the machine does only adds to them), and the time of
importing launch and launch_ros.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
import os
from pathlib import Path
import signal
import statistics
import subprocess
import sys
import tempfile
import time

from husky_runtime.domains import in_own_domain

_NODE = """
import sys, time, rclpy
from rclpy.executors import ExternalShutdownException
rclpy.init()
node = rclpy.create_node(f'node_{sys.argv[1]}')
open(sys.argv[2], 'w').write(repr(time.monotonic()))
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""
_LAUNCH_FILE = """
import sys
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def nodes(context):
    folder = LaunchConfiguration('folder').perform(context)
    return [
        Node(executable=sys.executable, arguments=[folder + '/node.py', str(index),
             f'{folder}/{index}'])
        for index in range(int(LaunchConfiguration('number').perform(context)))
    ]

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('folder'), DeclareLaunchArgument('number'),
        OpaqueFunction(function=nodes),
    ])
"""
_DEADLINE_SEC = 60.0


def _wait_for_nodes(folder: Path, number: int) -> float:
    """Return when the last node ran, on the monotonic clock."""
    paths = [folder / str(index) for index in range(number)]
    deadline = time.monotonic() + _DEADLINE_SEC
    while time.monotonic() < deadline:
        texts = [path.read_text() for path in paths if path.exists()]
        if len(texts) == number and all(texts):
            return max(float(text) for text in texts)
        time.sleep(0.02)
    raise TimeoutError(f'only {len(texts)} of {number} nodes ran after {_DEADLINE_SEC} s')


def _measure(start: Callable[[Path], list[subprocess.Popen[bytes]]], number: int) -> float:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / 'node.py').write_text(_NODE)
        (folder / 'nodes.launch.py').write_text(_LAUNCH_FILE)
        started = time.monotonic()
        processes = start(folder)
        try:
            return _wait_for_nodes(folder, number) - started
        finally:
            for process in processes:
                process.send_signal(signal.SIGINT)
            for process in processes:
                process.wait(_DEADLINE_SEC)


def _popen(*words: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def _import_sec() -> float:
    def once(code: str) -> float:
        started = time.perf_counter()
        subprocess.run([sys.executable, '-c', code], check=True)
        return time.perf_counter() - started

    return min(once('import launch, launch_ros.actions') for _ in range(5)) - min(
        once('pass') for _ in range(5)
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--nodes', type=int, default=10, help='how many nodes (default: 10)')
    parser.add_argument('--runs', type=int, default=5, help='how many runs of each (default: 5)')
    arguments = parser.parse_args()
    number = arguments.nodes

    def by_hand(folder: Path) -> list[subprocess.Popen[bytes]]:
        script = str(folder / 'node.py')
        return [
            _popen(sys.executable, script, str(index), str(folder / str(index)))
            for index in range(number)
        ]

    def by_launch(folder: Path) -> list[subprocess.Popen[bytes]]:
        file = str(folder / 'nodes.launch.py')
        return [_popen('ros2', 'launch', file, f'folder:={folder}', f'number:={number}')]

    with tempfile.TemporaryDirectory() as logs:
        os.environ.setdefault('ROS_LOG_DIR', logs)
        pairs = [
            (_measure(by_hand, number), _measure(by_launch, number)) for _ in range(arguments.runs)
        ]
    medians = [statistics.median(pair[index] for pair in pairs) for index in (0, 1)]
    hand, launch = (min(pair[index] for pair in pairs) for index in (0, 1))
    print(f'{number} nodes by hand, s:       {" ".join(f"{pair[0]:.2f}" for pair in pairs)}')
    print(f'{number} nodes by ros2 launch, s: {" ".join(f"{pair[1]:.2f}" for pair in pairs)}')
    print(f'medians: {medians[0]:.2f} and {medians[1]:.2f} s')
    print(f'best: {hand:.2f} and {launch:.2f} s, difference {launch - hand:+.2f} s (limit 1.5)')
    print(f'load of the machine meanwhile: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores')
    print(f'import of launch and launch_ros: {_import_sec():.3f} s (limit 0.15)')
    return 0 if launch - hand <= 1.5 else 1


if __name__ == '__main__':
    with in_own_domain():
        sys.exit(main())
