# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade one waypoint file: course, route, run, report."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
import time
from typing import Any

from husky_course.record import FILE_NAME, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course

from husky_grader.report.files import keep_course, summary, write_report
from husky_grader.scoring.report import judge


@dataclass(frozen=True)
class Grade:
    """The result of one file: a report as in report.json, or why there is none."""

    file: str
    report: dict[str, Any] | None
    text: str  # for the terminal
    refused: str = ''
    undone: bool = False  # for what this computer lacked, as room: no fault of the file

    @property
    def passed(self) -> bool:
        return self.report is not None and bool(self.report['passed'])

    @property
    def score(self) -> float:
        return 0.0 if self.report is None else float(self.report['score'])


def grade_file(
    file: str,
    folder: Path,
    *,
    world: str = '',
    picture: bool = True,
    each_second: Callable[[], object] = lambda: None,
) -> Grade:
    """
    Drive the course of a file in the simulator and write the report on it.

    :param picture: whether the report has path.png, which takes a sixth of the time.
    :param each_second: called with every second of simulated time.
    :raises OSError: when the report cannot be written.
    """
    begun = time.monotonic()
    try:
        route = plan_route(load_course(file))
        from husky_grader.run.in_process import drive_route  # MuJoCo takes its time

        record, drive = drive_route(
            route, world=world, record=folder / FILE_NAME, each_second=each_second
        )
        run = read_run(record)
    except ValueError as error:
        return Grade(file, None, str(error), refused=str(error))
    report = judge(run, route, wall_time_sec=time.monotonic() - begun)
    if drive.failure:
        report = replace(report, reasons=(*report.reasons, f'gave up: {drive.failure}'))
    text = summary(report)
    keep_course(Path(file), folder)
    return Grade(file, write_report(folder, report, run, route, picture=picture), text)
