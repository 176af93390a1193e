#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Kill nodes hard beside clean-ups of shared memory, and count what the next ones lose.

    ./lab exec python benchmark/killed_nodes.py [--pairs 3] [--cleaners 2] [--seconds 240]

A server and a client begin at the same moment, in a domain where the last two were killed hard, a
fourth of them while they began. All that is sent to a node is lost, in silence, if the name of its
port was removed; a node hangs if one was killed that made the same port.
See husky_runtime.shared_memory. Fast DDS takes one name of a thousand itself, where nodes begin at
the same moment, also without clean-ups.
"""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
import os
from pathlib import Path
import random
import subprocess
import sys
import time

from husky_runtime.domains import OwnDomain

_SERVER = """
import rclpy
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node('server')
node.create_service(Empty, 'answer', lambda _, response: response)
rclpy.spin(node)
"""
_CLIENT = """
import rclpy
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node('client')
client = node.create_client(Empty, 'answer')
client.wait_for_service()
rclpy.spin_until_future_complete(node, client.call_async(Empty.Request()))
print('answered')
"""
_CLEANER = """
import random, time
from husky_runtime.shared_memory import clean_shared_memory

while True:
    clean_shared_memory()
    time.sleep(random.uniform(0.0, 0.3))
"""
_LOST_SEC = 20.0  # an answer takes 0.3 s here, with the start of both
_BEGINS_SEC = 0.4


def _start(program: str, environment: dict[str, str]) -> subprocess.Popen[bytes]:
    command = [sys.executable, '-c', program]
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE)


def _has_lost_a_port(pid: int) -> bool:
    """Tell whether others find a port no more that a process has mapped: proc(5)."""
    maps = Path(f'/proc/{pid}/maps').read_text(encoding='utf-8')
    return any('fastrtps_port' in line and '(deleted)' in line for line in maps.splitlines())


def _count(seed: int, end_sec: float) -> Counter[str]:
    """Let pairs of nodes meet until the time is up, and be killed."""
    choose, counts = random.Random(seed), Counter[str]()  # noqa: S311 -- when to kill is no secret
    with OwnDomain() as domain:
        environment = {**os.environ, **domain.environment}
        while time.monotonic() < end_sec:
            server, client = (_start(program, environment) for program in (_SERVER, _CLIENT))
            counts['pairs'] += 1
            if choose.random() < 0.25:
                time.sleep(choose.uniform(0.0, _BEGINS_SEC))
                counts['killed while they begin'] += 1
            else:
                try:
                    answered = client.communicate(timeout=_LOST_SEC)[0] == b'answered\n'
                except subprocess.TimeoutExpired:
                    answered = False
                counts['without an answer'] += not answered
                counts['that lost a port'] += _has_lost_a_port(server.pid)
            for node in (server, client):
                node.kill()
                node.communicate()
    return counts


def main() -> int:
    """Run the benchmark; exit status 1 where there was no answer."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--pairs', type=int, default=3)
    parser.add_argument('--cleaners', type=int, default=2)
    parser.add_argument('--seconds', type=float, default=240.0)
    args = parser.parse_args()
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    end_sec = time.monotonic() + args.seconds
    cleaners = [_start(_CLEANER, dict(os.environ)) for _ in range(args.cleaners)]
    try:
        with ThreadPoolExecutor(args.pairs) as threads:
            ends = [end_sec] * args.pairs
            counts = sum(threads.map(_count, range(args.pairs), ends), Counter[str]())
    finally:
        for cleaner in cleaners:
            cleaner.kill()
            cleaner.communicate()
    lost = counts['without an answer']
    print(
        f'{counts["pairs"]} pairs of nodes, {counts["killed while they begin"]} killed while they '
        f'begin: {lost} without an answer, {counts["that lost a port"]} that lost a port'
    )
    return 1 if lost else 0


if __name__ == '__main__':
    sys.exit(main())
