# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive one course ten times in lockstep, five of them on a loaded machine; print each hash.

Run it with `./lab exec python3 benchmark/repeatability.py [WAYPOINTS]`. Exit status 1 if two
trajectories differ in a single bit.
"""

from collections.abc import Iterator
from contextlib import contextmanager
import json
import os
from pathlib import Path
import subprocess
import sys
import tempfile

ROOT = Path(__file__).resolve().parent.parent
RUNS = 10


@contextmanager
def load(*, busy: bool) -> Iterator[None]:
    """Keep every core busy meanwhile."""
    count = (os.cpu_count() or 1) if busy else 0
    burners = [subprocess.Popen(['bash', '-c', 'while :; do :; done']) for _ in range(count)]
    try:
        yield
    finally:
        for burner in burners:
            burner.kill()
            burner.wait()


def trajectory(waypoints: str, *, busy: bool) -> tuple[str, float]:
    """Drive once; return the trajectory's hash and the wall time, s."""
    with tempfile.TemporaryDirectory() as folder, load(busy=busy):
        command = [str(ROOT / 'lab'), 'drive', '--fast', '--no-view']
        command += ['--waypoints', waypoints, '--report', folder]
        subprocess.run(command, check=True, capture_output=True)
        report = json.loads((Path(folder) / 'report.json').read_text())
    return report['trajectory_sha256'], report['wall_time_sec']


def main() -> int:
    default = str(ROOT / 'config' / 'waypoints' / 'central_barrier.yaml')
    waypoints = sys.argv[1] if len(sys.argv) > 1 else default
    hashes = set()
    for number in range(RUNS):
        busy = number >= RUNS // 2
        digest, wall_time_sec = trajectory(waypoints, busy=busy)
        hashes.add(digest)
        print(f'{"loaded" if busy else "idle":6} {wall_time_sec:6.2f} s  {digest}', flush=True)
    print(f'{len(hashes)} trajectory in {RUNS} runs' if len(hashes) == 1 else 'THEY DIFFER')
    return len(hashes) != 1


if __name__ == '__main__':
    sys.exit(main())
