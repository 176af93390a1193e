# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Drive ten courses on every floor, with the noise and the unequal loads of the original.

Prints, for each floor, how many runs passed, and how far off the path they were, as the table of
docs/simulator.md; and for each course and floor the worst run. Run it with
`./lab exec python3 benchmark/floors.py [SEEDS] [--battery]`; SEEDS is how many runs of each there
are (20), and --battery gives the motors a limit of power.
Exit status 1 if a run is not complete, touches something, or is more than 0.05 m RMS off the path.
"""

from argparse import ArgumentParser
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from itertools import product
import os
from pathlib import Path
import statistics
import sys

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import Course, load_course, Waypoint
from husky_grader.run.in_process import Conditions, drive_route
from husky_grader.scoring.report import judge

FLOORS = ('asphalt', 'concrete_indoor', 'wet', 'gravel', 'grass')
RMS_M = 0.05
FOLDER = Path(__file__).resolve().parent.parent / 'config' / 'waypoints'


def _course(
    name: str, *places: tuple[float, float], speed: float, reverse: bool = False
) -> Course:
    points = [Waypoint(x, y, reverse=reverse and i > 0) for i, (x, y) in enumerate(places)]
    return Course(name, tuple(points), speed_m_s=speed)


# What the files have little of: sharp corners, a long way back, tight bends.
MORE = (
    _course('zigzag', (0, 0), (-1, 1), (-2, -1), (-3, 1), (-4, -1), (-5, 0.5), speed=0.5),
    _course('backwards', (0, 0), (-1.5, 0.8), (-3, 0), (-4.5, -0.8), (-6, 0), speed=0.4,
            reverse=True),
    _course('loop', (0, 0), (-2, 1.4), (-4.5, 1.2), (-5.8, 0), (-4.5, -1.2), (-2, -1.4),
            (-0.5, -0.4), speed=0.8),
)  # fmt: skip

Run = tuple[str, str, int, bool, int, float]


def drive(case: tuple[Course, str, int, bool]) -> Run:
    """Return course, floor, seed, whether it is complete, touches, and RMS off the path."""
    course, floor, seed, battery = case
    route = plan_route(course)
    conditions = Conditions(floor=floor, realistic=True, seed=seed, battery=battery)
    report = judge(read_run(drive_route(route, conditions=conditions)[0]), route)
    touches = len(report.collisions)
    return course.name, floor, seed, report.completed, touches, report.cross_track_rms_m


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('seeds', metavar='SEEDS', nargs='?', type=int, default=20)
    parser.add_argument('--battery', action='store_true')
    options = parser.parse_args()
    courses = [load_course(file) for file in sorted(FOLDER.glob('*.yaml'))] + list(MORE)
    cases = list(product(courses, FLOORS, range(options.seeds), [options.battery]))
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        runs = list(pool.map(drive, cases, chunksize=4))
    by_floor: dict[str, list[Run]] = defaultdict(list)
    by_both: dict[tuple[str, str], list[Run]] = defaultdict(list)
    for run in runs:
        by_floor[run[1]].append(run)
        by_both[run[0], run[1]].append(run)
    print('| floor | runs | complete | touches | RMS off the path, median, m | greatest, m |')
    print('|---|---|---|---|---|---|')
    for floor, each in by_floor.items():
        rms_m = [run[5] for run in each]
        print(f'| `{floor}` | {len(each)} | {sum(run[3] for run in each)} | '
              f'{sum(run[4] for run in each)} | {statistics.median(rms_m):.3f} | '
              f'{max(rms_m):.3f} |')  # fmt: skip
    print('\n| greatest RMS, m | ' + ' | '.join(FLOORS) + ' |\n|---|' + '---|' * len(FLOORS))
    for course in courses:
        row = [max(run[5] for run in by_both[course.name, floor]) for floor in FLOORS]
        print(f'| {course.name} | ' + ' | '.join(f'{each:.3f}' for each in row) + ' |')
    return int(any(not run[3] or run[4] or run[5] > RMS_M for run in runs))


if __name__ == '__main__':
    sys.exit(main())
