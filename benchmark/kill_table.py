# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Kill each process of a drive hard, at random moments, and look at what stays.

After every kill: how long the rest took to end, what is left in the process table and of shared
memory, and whether the next drive, in the same ROS domain, gives the trajectory it always gives.
Run it with `./lab exec python3 benchmark/kill_table.py [--moments N] [--seed N] [NAME...]`.
Exit status 1 if anything stayed, took longer than 3 s, or drove otherwise.
"""

import argparse
from contextlib import suppress
from dataclasses import dataclass, field
import json
from pathlib import Path
import random
import subprocess
import sys
import tempfile
import time

from husky_runtime.descendants import adopt_orphans
from husky_runtime.domains import in_own_domain
from husky_runtime.shared_memory import clean_shared_memory, unused_files
import psutil

LAB = str(Path(__file__).resolve().parent.parent / 'lab')
MOMENTS = 20
LATEST_SEC = 4.0  # after the process has started
ALLOWED_SEC = 3.0
PATIENCE_SEC = 30.0

# How each process of a drive is known by its command line.
PROCESSES = {
    'simulator': '/husky_sim/husky_sim',
    'driver': '/husky_driver/follow_path',
    'view': '/husky_view/view',
    'launch': 'drive.launch.py',
    './lab': '',
}


@dataclass
class Row:
    """What came of killing one process."""

    took_sec: list[float] = field(default_factory=list)
    stayed: int = 0
    shared_memory: int = 0
    wrong_runs: int = 0

    @property
    def good(self) -> bool:
        slow = max(self.took_sec) > ALLOWED_SEC
        return not (slow or self.stayed or self.shared_memory or self.wrong_runs)


def descendants() -> list[psutil.Process]:
    return [each for each in psutil.Process().children(recursive=True) if lives(each)]


def lives(process: psutil.Process) -> bool:
    try:
        return bool(process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False


def find(lab: psutil.Process, mark: str) -> psutil.Process | None:
    """Return the process of a drive, once it runs."""
    for each in [lab] if not mark else lab.children(recursive=True):
        try:
            if mark in ' '.join(each.cmdline()):
                return each
        except psutil.Error:  # it is just starting or ending
            continue
    return None


def kill_once(mark: str, moment_sec: float, row: Row, folder: Path) -> None:
    """Start a drive and kill one process of it a while after that has started."""
    clean_shared_memory()
    drive = [LAB, 'drive', '--report', str(folder)]
    if 'view' not in mark:
        drive.append('--no-view')
    with (folder / 'log').open('w') as log:
        child = subprocess.Popen(drive, stdout=log, stderr=log, start_new_session=True)
    lab, until_sec = psutil.Process(child.pid), time.monotonic() + PATIENCE_SEC
    while (victim := find(lab, mark)) is None:
        if time.monotonic() > until_sec:
            raise SystemExit(f'{mark} did not come in {PATIENCE_SEC:g} s')
        time.sleep(0.005)
    time.sleep(moment_sec)
    victim.kill()
    begun = time.monotonic()
    while descendants() and time.monotonic() - begun < 2 * ALLOWED_SEC:
        time.sleep(0.02)
    row.took_sec.append(time.monotonic() - begun)
    for each in descendants():
        row.stayed += 1
        with suppress(psutil.NoSuchProcess):
            print(f'  stayed: {" ".join(each.cmdline())[:120]}', flush=True)
            each.kill()
    child.wait()
    row.shared_memory += len(unused_files())


def drive_fast(folder: Path) -> str:
    """Drive the default course; return its trajectory, or nothing if that went wrong."""
    command = [LAB, 'drive', '--fast', '--no-view', '--report', str(folder)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout + done.stderr)
        return ''
    report = json.loads((folder / 'report.json').read_text())
    return str(report['trajectory_sha256'])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('names', nargs='*', metavar='NAME', help=f'of {", ".join(PROCESSES)}')
    parser.add_argument('--moments', type=int, default=MOMENTS)
    parser.add_argument('--seed', type=int, default=0)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    adopt_orphans()
    rows: dict[str, Row] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        right = drive_fast(folder)
        for process in options.names or PROCESSES:
            row = rows[process] = Row()
            for _ in range(options.moments):
                kill_once(PROCESSES[process], chance.uniform(0.0, LATEST_SEC), row, folder)
                row.wrong_runs += drive_fast(folder) != right
            print(
                f'{process:10} {options.moments} kills: the rest ended after '
                f'{sorted(row.took_sec)[len(row.took_sec) // 2]:.2f} s (median), '
                f'{max(row.took_sec):.2f} s (longest); stayed: {row.stayed} processes, '
                f'{row.shared_memory} files of shared memory; '
                f'{options.moments - row.wrong_runs} of {options.moments} next runs right',
                flush=True,
            )
    return not all(row.good for row in rows.values())


if __name__ == '__main__':
    with in_own_domain():
        sys.exit(main())
