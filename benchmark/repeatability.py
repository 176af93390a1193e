# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive one course twenty times in lockstep, ten of them on a loaded machine; print hash and score.

The same file is graded in one process as often; all must agree. Run it with
`./lab exec python3 benchmark/repeatability.py [WAYPOINTS]`. Exit status 1 if two trajectories
differ in a single bit, or two scores at all.
"""

from collections.abc import Iterator
from contextlib import contextmanager
import json
import os
from pathlib import Path
import subprocess
import sys
import tempfile

from husky_driver.processes import free_domain

ROOT = Path(__file__).resolve().parent.parent
RUNS = 20
WORDS = (['drive', '--fast', '--no-view', '--waypoints'], ['grade'])


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


def run(word: list[str], waypoints: str, *, busy: bool) -> tuple[str, float, float]:
    """Drive once; return the trajectory's hash, the score and the wall time, s."""
    with tempfile.TemporaryDirectory() as folder, load(busy=busy):
        command = [str(ROOT / 'lab'), *word, waypoints, '--report', folder]
        environment = {**os.environ, 'ROS_DOMAIN_ID': str(free_domain())}
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f'{" ".join(command)} failed:\n{done.stdout}{done.stderr}')
        report = json.loads((Path(folder) / 'report.json').read_text())
    return report['trajectory_sha256'], report['score'], report['wall_time_sec']


def main() -> int:
    default = str(ROOT / 'config' / 'waypoints' / 'central_barrier.yaml')
    waypoints = sys.argv[1] if len(sys.argv) > 1 else default
    results = set()
    for number in range(RUNS):
        busy = number >= RUNS // 2
        for word in WORDS:
            digest, score, wall_time_sec = run(word, waypoints, busy=busy)
            results.add((digest, score))
            how = f'{"loaded" if busy else "idle":6} {word[0]:5}'
            print(f'{how} {wall_time_sec:6.2f} s  {score:.6f}  {digest}', flush=True)
    count = RUNS * len(WORDS)
    print(f'1 trajectory, 1 score in {count} runs' if len(results) == 1 else 'THEY DIFFER')
    return len(results) != 1


if __name__ == '__main__':
    sys.exit(main())
