# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade waypoint files, or a run that the simulator has recorded."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import json
from pathlib import Path
import sys
import time
from typing import Any

from husky_driver.command_line import BAD_INPUT, Parser
from husky_driver.report import as_json, summary, write_report
from husky_driver.run_record import load_record, read_run
from husky_driver.score_parts import FORMULA
from husky_driver.scoring import judge
from husky_driver.waypoints import Course, load_course

PASSED, NOT_PASSED = 0, 1


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog='grade',
        description=__doc__,
        epilog=FORMULA,
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('files', metavar='FILE', nargs='*', help='waypoint files to grade')
    parser.add_argument('--record', metavar='FILE', help="what the simulator's 'record' wrote")
    parser.add_argument('--waypoints', metavar='FILE', help='the course of that record')
    parser.add_argument('--robot', metavar='NAME', help='which robot of the record')
    parser.add_argument(
        '--report', metavar='DIR', default='report', help='where the reports go (%(default)s)'
    )
    parser.add_argument(
        '--wall-time', metavar='SEC', type=float, help='how long the run took on the clock'
    )
    parser.add_argument('--json', action='store_true', help='print the report as JSON')
    parser.add_argument('--world', metavar='FILE', default='', help='MJCF world (the playpen)')
    return parser


def main(args: Sequence[str] | None = None) -> int:
    parser = _parser()
    options = parser.parse_args(args)
    if bool(options.files) == bool(options.record):
        parser.error('give waypoint files, or --record FILE with --waypoints FILE')
    if options.record and not options.waypoints:
        parser.error('--record needs --waypoints FILE, the course that was driven')
    try:
        if options.record:
            course = load_course(options.waypoints)
            record = load_record(options.record)
            return _grade(course, record, Path(options.report), options, options.wall_time)
        return _grade_files(options)
    except (ValueError, OSError) as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        return 130


def _grade_files(options: argparse.Namespace) -> int:
    from husky_driver.rehearsal import drive_course  # the simulator takes its time

    begun = time.monotonic()
    (name,) = options.files
    course = load_course(name)
    record, _ = drive_course(course, world=options.world)
    return _grade(course, record, Path(options.report), options, time.monotonic() - begun)


def _grade(
    course: Course,
    record: dict[str, Any],
    folder: Path,
    options: argparse.Namespace,
    wall_time_sec: float | None,
) -> int:
    run = read_run(record, options.robot)
    report = judge(run, course, wall_time_sec=wall_time_sec)
    write_report(folder, report, run, course)
    if options.json:
        print(json.dumps(as_json(report), indent=2))
    else:
        print(summary(report))
        print(f'  report: {folder / "report.html"}')
    return PASSED if report.passed else NOT_PASSED


if __name__ == '__main__':
    sys.exit(main())
