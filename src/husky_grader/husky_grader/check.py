# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Check a waypoint file, and the course against the obstacles of a world; draw it if asked."""

import argparse
from collections.abc import Sequence
from pathlib import Path
import sys

from husky_course.frames import Pose
from husky_course.printable import printable
from husky_course.route import plan_route, Point, Route, Survey
from husky_course.waypoints import load_course
from husky_runtime.command_line import BAD_INPUT, Parser, run_printing, why

from husky_grader.playpen import check_route

TOO_NEAR = 1


def main(args: Sequence[str] | None = None) -> int:
    parser = Parser(prog='check', description=__doc__, allow_abbrev=False)
    parser.add_argument('files', metavar='FILE', nargs='+', help='waypoint files')
    parser.add_argument('--world', metavar='FILE', default='', help='MJCF world (the playpen)')
    parser.add_argument(
        '--start',
        metavar=('X', 'Y', 'YAW'),
        nargs=3,
        type=float,
        default=(0.0, 0.0, 0.0),
        help='where the robot starts in the world: m, m, rad (0 0 0)',
    )
    parser.add_argument('--draw', metavar='FILE', help='draw the course: a .png or .svg file')
    strictness = parser.add_mutually_exclusive_group()
    strictness.add_argument(
        '--refuse', action='store_true', help='fail also when it passes too near to an obstacle'
    )
    strictness.add_argument(
        '--warn', action='store_true', help='only warn, also when it goes through an obstacle'
    )
    options = parser.parse_in_any_order(args, 'files')
    if options.draw and len(options.files) > 1:
        parser.error('--draw draws one course; give one waypoint file')
    if options.draw and Path(options.draw).suffix not in ('.png', '.svg'):
        parser.error(f'--draw {options.draw}: the name must end in .png or .svg')
    return run_printing(parser.prog, lambda: max(_check(name, options) for name in options.files))


def _check(name: str, options: argparse.Namespace) -> int:
    x, y, yaw = options.start
    try:
        route = plan_route(load_course(name))
        found = check_route(route, world=options.world, start=(x, y, yaw))
        if options.draw:
            _draw(route, found, (x, y, yaw), Path(options.draw))
    except (ValueError, OSError) as error:
        text = why(error) if isinstance(error, OSError) else str(error)
        print(printable(text, keep='\n'), file=sys.stderr)
        return BAD_INPUT
    for near in found.near:
        print(printable(f'{name}: {near}'), file=sys.stderr)
    print(printable(f'{name}: {describe(route, found)}'))
    if found.touched and not options.warn:
        return BAD_INPUT
    return TOO_NEAR if found.near and options.refuse else 0


def describe(route: Route, found: Survey) -> str:
    """Return one line about a course."""
    course = route.course
    places = 'one place' if len(found.near) == 1 else f'{len(found.near)} places'
    verdict = f'too near in {places}' if found.near else 'ok'
    if found.touched:
        verdict = f'goes through {" and ".join(found.touched)}'
    back = ' (the last is the first again)' if course.loop else ''
    nearest = ''
    if found.least_m is not None:
        nearest = f', nearest obstacle {found.nearest} at {found.least_m:.2f} m'
    return (
        f'{verdict}: {len(course.stops)} waypoints{back}, {route.length_m:.2f} m, '
        f'about {route.par_time_sec:.0f} s{nearest}'
    )


def _draw(route: Route, found: Survey, start: Pose, path: Path) -> None:
    from husky_grader.report.map import course_map, write_picture

    marks: list[Point] = [(near.x, near.y) for near in found.near]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_picture(course_map(route, found.obstacles, start, marks), path)


if __name__ == '__main__':
    sys.exit(main())
