# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A report as text, as report.json, as a page (report.html) and as a picture (path.png)."""

from dataclasses import asdict
import json
from pathlib import Path
from typing import Any

from husky_course.files import replacing
from husky_course.printable import printable
from husky_course.record import COURSE_NAME, Run
from husky_course.route import Route
from markupsafe import Markup

from husky_grader.report.map import Key, map_key, map_svg, run_map, STYLE_FOLDER, write_picture
from husky_grader.report.page import rendered
from husky_grader.report.plot import MAX_POINTS, Plot
from husky_grader.scoring.report import FORMULA, FULL_TRACKING_M, Report

PICTURE = 'path.png'
BAG = 'run.mcap'
REPORT_FILES = ('report.json', 'report.html', PICTURE)
JSON_KEYS = (
    *('course', 'passed', 'completed', 'ended_early', 'waypoints_reached', 'waypoints_total'),
    *('collisions', 'disturbances'),
    *('cross_track_rms_m', 'cross_track_max_m', 'min_clearance_m', 'path_length_m', 'driven_m'),
    *('sim_time_sec', 'wall_time_sec', 'acceleration_rms_m_s2', 'yaw_acceleration_rms_rad_s2'),
    *('conditions', 'trajectory_sha256', 'score', 'parts', 'reasons', 'ending', 'pace', 'printed'),
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
    lists = ('collisions', 'disturbances', 'parts', 'reasons', 'conditions')
    return (
        all(isinstance(content[key], list) for key in lists)
        and all(isinstance(reason, str) for reason in content['reasons'])
        and all(isinstance(content[key], bool) for key in ('passed', 'completed', 'ended_early'))
        and isinstance(content['score'], (int, float))
        and isinstance(content['course'], str)
    )


def write_report(
    folder: Path, report: Report, run: Run, route: Route, *, picture: bool = True
) -> dict[str, Any]:
    """
    Write the report's files, each whole or not at all; return what report.json holds.

    :param picture: whether path.png is written; what it shows is in report.html, too.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / BAG).unlink(missing_ok=True)  # it is of another run
    content = as_json(report)
    _write(folder / 'report.json', json.dumps(content, indent=2) + '\n')
    scene = run_map(run, route, report)
    if picture:
        with replacing(folder / PICTURE) as part:
            write_picture(scene, part)
    else:
        (folder / PICTURE).unlink(missing_ok=True)  # it would be of another run
    _write(folder / 'report.html', page(report, run, map_svg(scene), map_key(scene)))
    return content


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
    if report.conditions:
        lines.append(f'  driven with {" ".join(report.conditions)}')
    lines += [
        f'  {part.name:<11} x {part.factor:.3f}  costs {part.cost_points:4.1f}: {part.why}'
        for part in report.parts
    ]
    lines += [f'  ! {reason}' for reason in report.reasons]
    if report.ending:
        lines.append(f'  the run ended: {report.ending}; time passed {report.pace}')
    return '\n'.join(map(printable, lines))


def _write(path: Path, text: str) -> None:
    with replacing(path) as part:
        part.write_text(text, encoding='utf-8')


def keep_course(file: Path, folder: Path) -> None:
    """Keep the file beside the record of its run, for `./lab view`."""
    kept = folder / COURSE_NAME
    if not (kept.exists() and kept.samefile(file)):
        with replacing(kept) as part:
            part.write_bytes(file.read_bytes())


def page(report: Report, run: Run, drawing: str, key: Key) -> str:
    """
    Return the page as HTML text.

    :param drawing: the map as SVG.
    :param key: the colours on the map, and what they mean.
    """
    return rendered(
        STYLE_FOLDER / 'report.html.jinja',
        [STYLE_FOLDER / 'map.css'],
        report=report,
        map={'svg': Markup(drawing), 'key': key},
        plots=_plots(report, run),
        full_m=FULL_TRACKING_M,
        formula=_formula(),
    )


def _plots(report: Report, run: Run) -> dict[str, Markup]:
    """Return the deviation and the speed over time; nothing of a robot that did not drive."""
    begin, end = report.begin, report.end + 1
    if end - begin < 2:
        return {}
    shown = slice(begin, end, max(1, (end - begin) // MAX_POINTS))
    times = run.time_sec[shown].tolist()
    touched = [touch.time_sec for touch in report.collisions]
    full = (-FULL_TRACKING_M, FULL_TRACKING_M)
    errors = {'true': report.errors_m[shown].tolist()}
    speeds = {
        'asked': report.asked_m_s[shown].tolist(),
        'commanded': run.command_speed_m_s[shown].tolist(),
        'true': run.speed_m_s[shown].tolist(),
    }
    error = Plot('metres off the path over seconds', times, errors, full, touched)
    speed = Plot('metres per second over seconds', times, speeds, None, touched)
    return {'error': Markup(error.svg()), 'speed': Markup(speed.svg())}


def _formula() -> dict[str, Any]:
    """Split the formula into entries: a name begins one, deeper lines go on with it."""
    first, *lines = FORMULA.splitlines()
    parts: list[tuple[str, str]] = []
    for line in lines:
        if line[2] == ' ':
            parts[-1] = (parts[-1][0], f'{parts[-1][1]} {line.strip()}')
        else:
            name, text = line.split(maxsplit=1)
            parts.append((name, text))
    return {'first': first, 'parts': parts}
