# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Measure how long a class takes, of workspaces and of waypoint files, and how much memory.

Each workspace is the lab sheet's solution, built, run and driven in a jail; each file is the
course around the central barrier. Memory is the sum of all that the grader has started, each page
counted once (PSS), looked at twice a second. Run it on a quiet machine with
`./lab exec python3 benchmark/class_grading.py [--workspaces N] [--files N]`.
"""

import argparse
from collections.abc import Callable
import os
from pathlib import Path
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import psutil

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))
from playpen_testing.solution import COURSE, write_solution  # noqa: E402

GRADE = [sys.executable, '-m', 'husky_grader.grade']
LOOK_SEC = 0.5


def pss_mb(pid: int) -> float:
    """Return the memory of a process and all its descendants, in MB; shared pages count once."""
    total = 0.0
    try:
        tree = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
    except psutil.NoSuchProcess:
        return 0.0
    for process in tree:
        try:
            text = Path(f'/proc/{process.pid}/smaps_rollup').read_text()
        except OSError:
            continue
        total += next(int(line.split()[1]) for line in text.splitlines() if line[:4] == 'Pss:')
    return total / 1024


def run(command: list[str], environment: dict[str, str]) -> tuple[float, float]:
    """Run a command; return how many seconds it took, and the most memory that it used in MB."""
    most_mb, begun = 0.0, time.monotonic()
    with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL) as running:
        while running.poll() is None:
            most_mb = max(most_mb, pss_mb(running.pid))
            time.sleep(LOOK_SEC)
    return time.monotonic() - begun, most_mb


def workspaces(count: int, folder: Path, environment: dict[str, str]) -> None:
    solution = write_solution(folder)
    handed_in, report = folder / 'handed_in', folder / 'report'
    handed_in.mkdir()
    for number in range(count):
        (solution / 'src' / 'topic_demo' / 'NOTES').write_text(f'of group {number}\n')
        name = handed_in / f'group_{number:03}'
        shutil.make_archive(str(name), 'gztar', folder, solution.name)
    command = [*GRADE, '--lab', str(handed_in), '--report', str(report)]
    took_sec, most_mb = run(command, environment)
    each_sec = [
        (place / 'lab.json').stat().st_mtime - (place / 'handed_in').stat().st_mtime
        for place in report.glob('group_*')
    ]
    print(
        f'{count} workspaces: {took_sec:.0f} s, {took_sec / count:.1f} s for each; from unpacked '
        f'to graded {statistics.median(each_sec):.1f} s in median, {max(each_sec):.1f} s at most; '
        f'{most_mb:.0f} MB at most'
    )
    print((report / 'grades.csv').read_text().splitlines()[1])
    again_sec, _ = run(command, environment)
    print(f'the same again: {again_sec:.1f} s')


def files(count: int, folder: Path, environment: dict[str, str]) -> None:
    text = COURSE.read_text()
    places = [folder / f's{number:04}.yaml' for number in range(count)]
    for place in places:
        place.write_text(f'{text}# {place.stem}\n')
    command = [*GRADE, *map(str, places), '--report', str(folder / 'report')]
    took_sec, most_mb = run(command, environment)
    print(
        f'{count} waypoint files: {took_sec:.0f} s, {took_sec / count:.2f} s for each; '
        f'{most_mb:.0f} MB at most'
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workspaces', type=int, default=60)
    parser.add_argument('--files', type=int, default=1000)
    options = parser.parse_args()
    measures: dict[Callable[[int, Path, dict[str, str]], None], int] = {
        workspaces: options.workspaces,
        files: options.files,
    }
    for measure, count in measures.items():
        with tempfile.TemporaryDirectory(prefix='class_') as name:
            folder = Path(name)
            folder.chmod(0o755)
            if count:
                measure(count, folder, {**os.environ, 'XDG_STATE_HOME': str(folder / 'state')})


if __name__ == '__main__':
    main()
