# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a report (report.json, report.html and path.png), and its summary as text."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
import json
from pathlib import Path
from typing import Any

from husky_course.printable import printable
from husky_course.record import Run
from husky_course.route import Route

from husky_grader.report.map import run_map, write_picture
from husky_grader.report.page import page
from husky_grader.scoring.report import Report

REPORT_FILES = ('report.json', 'report.html', 'path.png')
JSON_KEYS = (
    *('course', 'passed', 'completed', 'ended_early', 'waypoints_reached', 'waypoints_total'),
    *('collisions', 'disturbances'),
    *('cross_track_rms_m', 'cross_track_max_m', 'min_clearance_m', 'path_length_m', 'driven_m'),
    *('sim_time_sec', 'wall_time_sec', 'acceleration_rms_m_s2', 'yaw_acceleration_rms_rad_s2'),
    *('trajectory_sha256', 'score', 'parts', 'reasons'),
)


def as_json(report: Report) -> dict[str, Any]:
    """Return what report.json holds."""
    content = {key: getattr(report, key) for key in JSON_KEYS}
    for key in ('collisions', 'disturbances', 'parts'):
        content[key] = [asdict(entry) for entry in content[key]]
    # Through JSON, so that it is the same whether it was written and read, or not.
    read: dict[str, Any] = json.loads(json.dumps(content))
    return read


def is_report(content: object) -> bool:
    """Tell whether what was read has the shape of report.json."""
    if not isinstance(content, dict) or set(content) != set(JSON_KEYS):
        return False
    lists = ('collisions', 'disturbances', 'parts', 'reasons')
    return (
        all(isinstance(content[key], list) for key in lists)
        and all(isinstance(reason, str) for reason in content['reasons'])
        and all(isinstance(content[key], bool) for key in ('passed', 'completed', 'ended_early'))
        and isinstance(content['score'], (int, float))
        and isinstance(content['course'], str)
    )


def write_report(folder: Path, report: Report, run: Run, route: Route) -> None:
    """Write the three files, each whole or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = run_map(run, route, report)
    _write(folder / 'report.json', json.dumps(as_json(report), indent=2) + '\n')
    _write(folder / 'report.html', page(report, run, scene))
    with replacing(folder / 'path.png') as part:
        write_picture(scene, part)


def summary(report: Report) -> str:
    """Return the report for a terminal."""
    verdict = 'passed' if report.passed else 'NOT PASSED'
    clearance, touches = report.min_clearance_m, len(report.collisions)
    near = '' if clearance is None else f', nearest obstacle {clearance:.2f} m'
    lines = [
        f'{report.course}: {verdict}, score {report.score:.1f} of 100',
        f'  {report.waypoints_reached} of {report.waypoints_total} waypoints, '
        f'{touches} collision{"" if touches == 1 else "s"}, {report.driven_m:.2f} m in '
        f'{report.sim_time_sec:.2f} s',
        f'  off the path {report.cross_track_rms_m:.3f} m RMS, '
        f'{report.cross_track_max_m:.3f} m at most{near}',
    ]
    lines += [
        f'  {part.name:<11} x {part.factor:.3f}  costs {part.cost_points:4.1f}: {part.why}'
        for part in report.parts
    ]
    lines += [f'  ! {reason}' for reason in report.reasons]
    return '\n'.join(map(printable, lines))


def _write(path: Path, text: str) -> None:
    with replacing(path) as part:
        part.write_text(text, encoding='utf-8')


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give the name of a file to write; it takes the place of `path`, unless something fails."""
    part = path.with_name(f'.{path.stem}.part{path.suffix}')
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
