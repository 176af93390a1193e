#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measure messages that are made without a compiler: what they cost, and whether they stay whole.

    ./lab exec python benchmark/own_interfaces.py cost      # beside the wheel's Odometry
    ./lab exec python benchmark/own_interfaces.py memory    # a million messages
    ./lab exec python benchmark/own_interfaces.py random    # 5000 messages of 50 random types
    ./lab exec python benchmark/own_interfaces.py hashes    # every type of the wheels, made again
    ./lab exec python benchmark/own_interfaces.py stress    # ten times 60 s from many threads

Each prints a line of what it found; exit status 1 where something is wrong.
"""

from __future__ import annotations

import argparse
from importlib import import_module
import json
import os
from pathlib import Path
from random import Random
import subprocess
import sys
import sysconfig
import tempfile
import time
from typing import Any

from ament_index_python import get_package_share_directory
from colcon_rosidl_python.build import build
from colcon_rosidl_python.generator import generate
from geometry_msgs.msg import TransformStamped
from husky_runtime.domains import in_own_domain
from husky_sim.messages.cdr import decode, encode
from nav_msgs.msg import Odometry
import psutil
import rclpy
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py import get_interface_packages
from tf2_msgs.msg import TFMessage

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / 'test'))

from playpen_testing import interface_stress  # noqa: E402
from playpen_testing.random_definitions import write_package, write_random_package  # noqa: E402
from playpen_testing.random_messages import random_message  # noqa: E402

ROUNDS, ROUND_TRIPS = 20, 500


def installed(folder: Path) -> Any:
    """Build a package into a prefix of its own, and return its module of messages."""
    prefix = folder.parent / 'prefix'
    build(folder, prefix, link=False)
    sys.path.insert(0, sysconfig.get_path('purelib', vars={'base': str(prefix)}))
    os.environ['AMENT_PREFIX_PATH'] = f'{prefix}{os.pathsep}{os.environ["AMENT_PREFIX_PATH"]}'
    return import_module(f'{folder.name}.msg')


class RoundTrip:
    """Sends messages of a type to itself."""

    def __init__(self, node: Any, kind: Any, topic: str) -> None:
        self._node = node
        self._heard: list[Any] = []
        self._publisher = node.create_publisher(kind, topic, 10)
        node.create_subscription(kind, topic, self._heard.append, 10)
        while self._publisher.get_subscription_count() < 1:
            time.sleep(0.01)

    def __call__(self, message: Any) -> Any:
        self._heard.clear()
        self._publisher.publish(message)
        while not self._heard:
            rclpy.spin_once(self._node, timeout_sec=1.0)
        return self._heard[0]


def cost(folder: Path) -> int:
    """Compare the processor time of round trips, in turns."""
    definition = Path(get_package_share_directory('nav_msgs'), 'msg', 'Odometry.msg').read_text()
    write_package(folder / 'own_msgs', {'Odometry': definition})
    own = installed(folder / 'own_msgs').Odometry
    seconds: dict[Any, list[float]] = {Odometry: [], own: []}
    with in_own_domain():
        rclpy.init()
        node = rclpy.create_node('cost')
        trips = {kind: RoundTrip(node, kind, f't{i}') for i, kind in enumerate(seconds)}
        message = {kind: random_message(kind, Random(1)) for kind in seconds}
        for _ in range(ROUNDS):
            for kind, trip in trips.items():
                begin = time.process_time()
                for _ in range(ROUND_TRIPS):
                    trip(message[kind])
                seconds[kind].append(time.process_time() - begin)
        rclpy.shutdown()
    compiled, ours = (1e6 * min(times) / ROUND_TRIPS for times in seconds.values())
    print(f'round trip of Odometry: compiled {compiled:.0f} us, ours {ours:.0f} us of CPU')
    return int(ours > 2 * compiled)


def memory(count: int) -> int:
    """Let a million messages come, and see whether memory grows."""
    message = TFMessage(transforms=[TransformStamped(child_frame_id='wheel') for _ in range(5)])
    process, sizes = psutil.Process(), []
    with in_own_domain():
        rclpy.init()
        trip = RoundTrip(rclpy.create_node('memory'), TFMessage, 'tf')
        for i in range(count + 1):
            if i % (count // 10) == 0:
                sizes.append(process.memory_info().rss / 1e6)
            trip(message)
        rclpy.shutdown()
    print(f'{count} messages; MB after each tenth: {" ".join(f"{size:.1f}" for size in sizes)}')
    return int(sizes[-1] - sizes[1] > 1.0)


def random_types(folder: Path, types: int, messages: int) -> int:
    """Have an independent reader read messages of types that nobody has thought of."""
    random = Random(0)
    names = write_random_package(folder / 'random_msgs', types, random)
    module = installed(folder / 'random_msgs')
    wrong = 0
    for name in names:
        kind = getattr(module, name)
        for _ in range(messages // types):
            message = random_message(kind, random)
            data = bytes(serialize_message(message))
            same = decode(kind, data) == message == deserialize_message(data, kind)
            wrong += not same or data != encode(message)
    print(f'{messages} messages of {types} types: {wrong} wrong')
    return int(wrong > 0)


def hashes(folder: Path) -> int:
    """Make all packages of the wheels again, and compare hashes and descriptions."""
    shares = {name: Path(get_package_share_directory(name)) for name in get_interface_packages()}
    compared, wrong = 0, 0
    for name, share in shares.items():
        if (share / '.interfaces').exists():
            continue  # made by us
        paths = [path for path in share.glob('*/*') if path.suffix in ('.msg', '.srv', '.action')]
        generate(name, [path.relative_to(share) for path in paths], share, folder, shares)
        for path in paths:
            ours = folder / 'share' / name / path.relative_to(share).with_suffix('.json')
            theirs = path.with_suffix('.json')
            compared += 1
            wrong += json.loads(ours.read_text()) != json.loads(theirs.read_text())
    print(f'{compared} interfaces: {wrong} with another hash or description')
    return int(wrong > 0)


def stress(runs: int, seconds: float) -> int:
    """Run the stress again and again, each time in a process of its own."""
    failed = 0
    for _ in range(runs):
        with in_own_domain():
            words = [sys.executable, interface_stress.__file__, str(seconds)]
            done = subprocess.run(words, capture_output=True, text=True)
        print(done.stdout.strip() or done.stderr, flush=True)
        failed += done.returncode != 0
    print(f'{failed} of {runs} failed')
    return int(failed > 0)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('what', choices=['cost', 'memory', 'random', 'hashes', 'stress'])
    parser.add_argument('--messages', type=int, help='of memory (1000000) and random (5000)')
    parser.add_argument('--runs', type=int, default=10, help='of stress (10)')
    parser.add_argument('--seconds', type=float, default=60.0, help='of each run of stress (60)')
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if given.what == 'cost':
            return cost(Path(folder))
        if given.what == 'memory':
            return memory(given.messages or 1_000_000)
        if given.what == 'random':
            return random_types(Path(folder), 50, given.messages or 5000)
        if given.what == 'hashes':
            return hashes(Path(folder))
        return stress(given.runs, given.seconds)


if __name__ == '__main__':
    sys.exit(main())
