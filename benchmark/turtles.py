# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure what turtles cost that move all the time, with a page that reads.

    ./lab exec python3 benchmark/turtles.py

Prints, for each number of turtles: the share of a core that turtlesim takes, its poses a second,
and what the page is sent.
"""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading
import time
from urllib.request import urlopen

from ament_index_python import get_package_prefix
from husky_runtime.domains import in_own_domain
import psutil
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))
from playpen_testing.turtles import TurtleClient  # noqa: E402

NUMBERS = (1, 10, 50)
MEASURED_SEC = 5.0
COMMAND_SEC = 0.5  # well within the second for which a command counts


class Reader(threading.Thread):
    """Reads what a page is sent."""

    def __init__(self, address: str) -> None:
        super().__init__(daemon=True)
        self._address = address
        self.pictures = self.bytes = 0

    def run(self) -> None:
        with urlopen(f'{self._address}events') as stream:
            for line in stream:
                self.bytes += len(line)
                self.pictures += line.startswith(b'data: ')


@contextmanager
def turtlesim() -> Iterator[tuple[psutil.Process, str]]:
    """Run a turtlesim; give its process and the address of its page."""
    program = Path(get_package_prefix('turtlesim'), 'lib', 'turtlesim', 'turtlesim_node')
    with subprocess.Popen([program], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        lines = (re.search(r'http://\S+', line) for line in process.stderr)
        address = next(found[0] for found in lines if found)
        try:
            yield psutil.Process(process.pid), address
        finally:
            process.send_signal(signal.SIGINT)


def _is_over(end_sec: float) -> bool:
    return time.monotonic() > end_sec


def move(student: TurtleClient, count: int, duration_sec: float) -> None:
    """Let turtles go round for a time."""
    end = time.monotonic() + duration_sec
    while (now := time.monotonic()) < end:
        for number in range(count):
            student.command(f'turtle{number + 1}', x=1.0, turn=1.0)
        next_sec = min(now + COMMAND_SEC, end)
        student.wait_for(partial(_is_over, next_sec), 'the next command')


def measure(count: int) -> str:
    poses = [0]

    def on_pose(_: Pose) -> None:
        poses[0] += 1

    with turtlesim() as (process, address), TurtleClient() as student:
        for number in range(1, count):
            student.call(Spawn, 'spawn', x=2.0 + number % 7, y=2.0 + number // 7)
        student.node.create_subscription(Pose, 'turtle1/pose', on_pose, 7)
        reader = Reader(address)
        reader.start()
        move(student, count, 1.0)  # until all are found
        before = (poses[0], reader.pictures, reader.bytes)
        process.cpu_percent()
        began = time.monotonic()
        move(student, count, MEASURED_SEC)
        share, took_sec = process.cpu_percent(), time.monotonic() - began
        after = (poses[0], reader.pictures, reader.bytes)
    told = [(new - old) / took_sec for old, new in zip(before, after, strict=True)]
    return (
        f'{count:3} turtles: {share:3.0f} % of a core, {told[0]:.1f} poses a second of each, '
        f'{told[1]:.1f} pictures and {told[2] / 1000:.0f} kB a second'
    )


def main() -> int:
    ArgumentParser(description=__doc__.splitlines()[1]).parse_args()
    with in_own_domain():
        for count in NUMBERS:
            print(measure(count), flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
