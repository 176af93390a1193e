# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how well every course is followed, and how long grading takes.

Run it with `./lab exec python3 benchmark/following.py [FILES]`; FILES is how many files the class
has (100). Exit status 1 if a figure is worse than what the lab promises.
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
import subprocess
import sys
import tempfile
import time

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import Course, load_course
from husky_grader.run.in_process import drive_route
from husky_grader.scoring.report import judge, Report

ROOT = Path(__file__).resolve().parent.parent
COURSES = ROOT / 'config' / 'waypoints'
ODOMETRY = ('filtered', 'wheel', 'ground_truth')
GROUND_TRUTH_RMS_M = 0.03
SPEED_SHARE = 0.88
GRADE_SEC, CLASS_SEC = 3.0, 120.0


@dataclass(frozen=True)
class Promise:
    """The greatest distance from the path that is allowed, on odometry/filtered."""

    rms_m: float
    max_m: float


PROMISES = {'central_barrier': Promise(0.05, 0.15), 'grand_perimeter': Promise(0.25, 0.25)}


def broken(course: Course, odometry: str, report: Report) -> Iterator[str]:
    """Return what is worse than promised."""
    promise = PROMISES.get(course.name)
    if odometry == 'filtered' and not report.passed:
        yield 'not passed'
    if odometry == 'filtered' and promise and report.cross_track_rms_m > promise.rms_m:
        yield f'RMS above {promise.rms_m}'
    if odometry == 'filtered' and promise and report.cross_track_max_m > promise.max_m:
        yield f'greatest above {promise.max_m}'
    if odometry == 'ground_truth' and report.cross_track_rms_m > GROUND_TRUTH_RMS_M:
        yield f'RMS above {GROUND_TRUTH_RMS_M}'
    if odometry != 'wheel' and share(course, report) < SPEED_SHARE:
        yield f'slower than {SPEED_SHARE:.0%}'


def share(course: Course, report: Report) -> float:
    """Return the average speed over that which the course asks for, piece by piece."""
    asked = [point.speed_m_s or course.speed_m_s for point in course.stops[1:]]
    return report.path_length_m / report.sim_time_sec / (sum(asked) / len(asked))


def follow() -> int:
    """Print one line for each course and odometry; return how many promises are broken."""
    print('| course | odometry | waypoints | touches | RMS m | max m | speed | |')
    print('|---|---|---|---|---|---|---|---|')
    count = 0
    for file in sorted(COURSES.glob('*.yaml')):
        course = load_course(file)
        for odometry in ODOMETRY:
            record, _ = drive_route(plan_route(course), odometry=odometry)
            report = judge(read_run(record), plan_route(course))
            wrong = list(broken(course, odometry, report))
            count += len(wrong)
            print(
                f'| {course.name} | {odometry} | {report.waypoints_reached} of '
                f'{report.waypoints_total} | {len(report.collisions)} | '
                f'{report.cross_track_rms_m:.3f} | {report.cross_track_max_m:.3f} | '
                f'{share(course, report):.0%} | {", ".join(wrong)} |',
                flush=True,
            )
    return count


def grade(files: list[Path], folder: str) -> float:
    """Return how long `./lab grade` takes from command to report, s of wall time."""
    begun = time.monotonic()
    command = [str(ROOT / 'lab'), 'grade', *map(str, files), '--report', folder]
    subprocess.run(command, check=True, capture_output=True)
    return time.monotonic() - begun


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('files', metavar='FILES', nargs='?', type=int, default=100)
    number = parser.parse_args().files
    count = follow()
    course = COURSES / 'central_barrier.yaml'
    with tempfile.TemporaryDirectory() as folder:
        took = min(grade([course], folder) for _ in range(3))
    print(f'grading central_barrier: {took:.2f} s, best of 3 (promised: {GRADE_SEC:g} s)')
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f'student_{i:03}.yaml' for i in range(number)]
        for i, file in enumerate(files):
            file.write_text(f'# student {i}\n{course.read_text()}')
        whole = grade(files, folder)
    print(f'grading {number} files: {whole:.1f} s (promised for 100: {CLASS_SEC:g} s)')
    return int(count > 0 or took > GRADE_SEC or whole > CLASS_SEC * max(number, 1) / 100)


if __name__ == '__main__':
    sys.exit(main())
