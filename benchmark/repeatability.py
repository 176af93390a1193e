# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive one course 200 times and grade it 1000 times; all must agree to the last bit.

Each drive is `./lab drive --fast --no-view` in a fresh process, every second one beside four
spinning processes. The gradings are one class of copies of the file, then single ones in fresh
processes, as many as there are drives. Run it with
`./lab exec python3 benchmark/repeatability.py [--drives N] [--gradings N] [WAYPOINTS]`.
Exit status 1 if two trajectories or two scores differ, or if a run fails.
"""

import argparse
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
import json
import os
from pathlib import Path
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = Path(__file__).resolve().parent.parent
LAB = str(ROOT / 'lab')
DRIVES, GRADINGS = 200, 1000
SPINNING = 4

Result = tuple[str, float]  # trajectory and score


@contextmanager
def load(count: int) -> Iterator[None]:
    """Let so many processes spin meanwhile."""
    burners = [subprocess.Popen(['bash', '-c', 'while :; do :; done']) for _ in range(count)]
    try:
        yield
    finally:
        for burner in burners:
            burner.kill()
            burner.wait()


def run(word: list[str], report: Path) -> tuple[Result, float]:
    """Run a word of the lab that leaves one report; return what came of it and the wall time."""
    environment = {name: value for name, value in os.environ.items() if name != 'ROS_DOMAIN_ID'}
    begun = time.monotonic()
    done = subprocess.run(
        [LAB, *word, '--report', str(report)], env=environment, capture_output=True, text=True
    )
    took_sec = time.monotonic() - begun
    if done.returncode:
        return (
            f'failed with {done.returncode}: {done.stdout[-2000:]}{done.stderr}',
            0.0,
        ), took_sec
    content = json.loads((report / 'report.json').read_text())
    return (content['trajectory_sha256'], content['score']), took_sec


def repeat(name: str, word: list[str], count: int, found: Counter[Result]) -> None:
    """Run a word many times, every second one beside spinning processes."""
    for spinning in (0, SPINNING):
        times = []
        with load(spinning), tempfile.TemporaryDirectory() as folder:
            for _ in range(count // 2):
                result, took_sec = run(word, Path(folder))
                found[result] += 1
                times.append(took_sec)
        print(
            f'{count // 2} {name} beside {spinning} spinning processes: median '
            f'{statistics.median(times):.2f} s, longest {max(times):.2f} s; '
            f'{len(found)} different so far',
            flush=True,
        )


def grade_class(waypoints: str, count: int, found: Counter[Result]) -> None:
    """Grade copies of a file as a class."""
    with tempfile.TemporaryDirectory() as name:
        folder, files = Path(name), []
        for number in range(count):
            files.append(folder / f'{number}.yaml')
            shutil.copyfile(waypoints, files[-1])
        begun = time.monotonic()
        command = [LAB, 'grade', *map(str, files), '--report', str(folder / 'report')]
        subprocess.run(command, capture_output=True)
        for file in files:
            report = folder / 'report' / file.stem / 'report.json'
            content = json.loads(report.read_text()) if report.is_file() else {}
            found[content.get('trajectory_sha256', 'no report'), content.get('score', 0.0)] += 1
    print(f'{count} gradings of a class in {time.monotonic() - begun:.0f} s', flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    default = str(ROOT / 'config' / 'waypoints' / 'central_barrier.yaml')
    parser.add_argument('waypoints', nargs='?', default=default)
    parser.add_argument('--drives', type=int, default=DRIVES)
    parser.add_argument('--gradings', type=int, default=GRADINGS)
    options = parser.parse_args()
    found: Counter[Result] = Counter()
    drive = ['drive', '--fast', '--no-view', '--waypoints', options.waypoints]
    repeat('drives', drive, options.drives, found)
    singles = min(options.drives, options.gradings)
    repeat('gradings', ['grade', options.waypoints], singles, found)
    grade_class(options.waypoints, options.gradings - singles, found)
    for (digest, score), count in found.most_common():
        print(f'{count} times {score:.6f} {digest}')
    return len(found) != 1


if __name__ == '__main__':
    sys.exit(main())
