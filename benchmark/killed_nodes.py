#!/usr/bin/env python3
# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Kill nodes hard beside clean-ups of shared memory, and count what the next ones lose.

    ./lab exec python benchmark/killed_nodes.py [--pairs 3] [--cleaners 2] [--seconds 240]

A server and a client begin at the same moment, in a domain where the last two were killed hard, a
fourth of them while they began. The client awaits a message of a talker that has been there all
the time, then the answer of the server. All that is sent to a node is lost, in silence, if the
name of its port was removed, or if others go on to send to the port of who was there before; a
node hangs if one was killed that made the same port. See husky_runtime.shared_memory, and
underlay/mended_calls.py. Fast DDS takes one name of a thousand itself, where nodes begin at the
same moment, also without clean-ups.
"""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
import itertools
import os
from pathlib import Path
import random
import statistics
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
_TALKER = """
import rclpy
from std_msgs.msg import Empty

rclpy.init()
node = rclpy.create_node('talker')
publisher = node.create_publisher(Empty, 'talk', 10)
node.create_timer(0.005, lambda: publisher.publish(Empty()))
rclpy.spin(node)
"""
_CLIENT = """
import rclpy
from std_msgs.msg import Empty as Word
from std_srvs.srv import Empty

rclpy.init()
node = rclpy.create_node('client')
heard = rclpy.Future()
node.create_subscription(Word, 'talk', heard.set_result, 10)
rclpy.spin_until_future_complete(node, heard)
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


def _count(seed: int, end_sec: float) -> tuple[Counter[str], list[float]]:
    """Let pairs of nodes meet until the time is up, and be killed; return how long each took."""
    choose, counts = random.Random(seed), Counter[str]()  # noqa: S311 -- when to kill is no secret
    took_sec = []
    with OwnDomain() as domain:
        environment = {**os.environ, **domain.environment}
        talker = _start(_TALKER, environment)
        while time.monotonic() < end_sec:
            begun_sec = time.monotonic()
            server, client = (_start(program, environment) for program in (_SERVER, _CLIENT))
            counts['pairs'] += 1
            if choose.random() < 0.25:
                time.sleep(choose.uniform(0.0, _BEGINS_SEC))
                counts['killed while they begin'] += 1
            else:
                try:
                    said = client.communicate(timeout=_LOST_SEC)[0]
                    # Fast DDS may print a line where another takes the port that it tries first.
                    answered = said.splitlines()[-1:] == [b'answered']
                except subprocess.TimeoutExpired:
                    answered = False
                took_sec.append(time.monotonic() - begun_sec)
                counts['without an answer'] += not answered
                counts['that lost a port'] += _has_lost_a_port(server.pid)
            for node in (server, client):
                node.kill()
                node.communicate()
        talker.kill()
        talker.communicate()
    return counts, took_sec


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
            counted, took = zip(*threads.map(_count, range(args.pairs), ends), strict=True)
    finally:
        for cleaner in cleaners:
            cleaner.kill()
            cleaner.communicate()
    counts, took_sec = sum(counted, Counter[str]()), sorted(itertools.chain(*took))
    lost = counts['without an answer']
    print(
        f'{counts["pairs"]} pairs of nodes, {counts["killed while they begin"]} killed while they '
        f'begin: {lost} without an answer, {counts["that lost a port"]} that lost a port; '
        f'those left alone took {statistics.median(took_sec):.1f} s in the median, at most '
        f'{took_sec[-1]:.1f} s'
    )
    return 1 if lost else 0


if __name__ == '__main__':
    sys.exit(main())
