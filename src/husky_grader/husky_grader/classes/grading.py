# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade one waypoint file, and name all that its grade depends on."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
import hashlib
import importlib
from pathlib import Path
from threading import Thread
import time
from typing import Any

from husky_course.record import FILE_NAME, read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course

import husky_course
import husky_driver
import husky_grader
from husky_grader.report.atomic_file import replacing
from husky_grader.report.report import as_json, summary, write_report
from husky_grader.scoring.scoring import judge
import husky_sim

COURSE_FILE = 'waypoints.yaml'


@dataclass(frozen=True)
class Graded:
    """What came of one file: a report as in report.json, or why there is none."""

    file: str
    report: dict[str, Any] | None
    text: str  # for the terminal
    refused: str = ''
    unwritten: bool = False  # the report could not be kept, which is no fault of the file

    @property
    def passed(self) -> bool:
        return self.report is not None and bool(self.report['passed'])

    @property
    def collisions(self) -> int:
        return 0 if self.report is None else len(self.report['collisions'])

    @property
    def score(self) -> float:
        return 0.0 if self.report is None else float(self.report['score'])


def grade_file(
    file: str,
    folder: Path,
    *,
    world: str = '',
    each_second: Callable[[], object] = lambda: None,
) -> Graded:
    """
    Drive the course of a file in the simulator and write the report on it.

    :param each_second: called with every second of simulated time.
    :raises OSError: when the report cannot be written.
    """
    from husky_grader.run.rehearsal import drive_route  # the simulator takes its time

    begun = time.monotonic()
    try:
        route = plan_route(load_course(file))
        # To load matplotlib takes as long as to drive, and the physics leaves Python alone.
        Thread(target=_load_pictures, daemon=True).start()
        record, drive = drive_route(
            route, world=world, record=folder / FILE_NAME, each_second=each_second
        )
        run = read_run(record)
    except ValueError as error:
        return Graded(file, None, str(error), refused=str(error))
    report = judge(run, route, wall_time_sec=time.monotonic() - begun)
    if drive.failure:
        report = replace(report, reasons=(*report.reasons, f'gave up: {drive.failure}'))
    write_report(folder, report, run, route)
    keep_course(Path(file), folder)
    return Graded(file, as_json(report), summary(report))


def _load_pictures() -> None:
    with suppress(Exception):  # who draws hears of it
        importlib.import_module('husky_grader.report.map_png')


def keep_course(file: Path, folder: Path) -> None:
    """Keep the file beside the record of its run, for `./lab view`."""
    kept = folder / COURSE_FILE
    if not (kept.exists() and kept.samefile(file)):
        with replacing(kept) as part:
            part.write_bytes(file.read_bytes())


def key_of(file: str, world: str = '') -> str:
    """Return a hash of all that a grade depends on: the file, the world and the programs."""
    digest = _digest_of_programs(world).copy()
    _take(digest, Path(file))
    return digest.hexdigest()


@lru_cache(maxsize=1)
def _digest_of_programs(world: str) -> Any:
    digest = hashlib.sha256()
    for path in _programs_and_worlds(world):
        _take(digest, path)
    return digest


def _take(digest: Any, path: Path) -> None:
    """Add the content of a file; of a device or a pipe, which may never end, only a mark."""
    try:
        digest.update(path.read_bytes() if path.is_file() else b'?')
    except (OSError, ValueError):
        digest.update(b'?')


def _programs_and_worlds(world: str) -> list[Path]:
    paths: list[Path] = [Path(world)] if world else []
    for package in (husky_course, husky_driver, husky_grader, husky_sim):
        paths += sorted(Path(package.__path__[0]).rglob('*.py'))
    from husky_sim.world import default_worlds

    return [*paths, *sorted(default_worlds().glob('*.xml'))]
