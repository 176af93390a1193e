# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a report, from the template report.html.jinja."""

from __future__ import annotations

from typing import Any

from husky_course.printable import printable
from husky_course.record import Run
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from husky_grader.report.map import Map, map_svg, STYLE_FOLDER
from husky_grader.report.plot import MAX_POINTS, Plot
from husky_grader.scoring.report import FORMULA, FULL_TRACKING_M, Report


def page(report: Report, run: Run, scene: Map) -> str:
    """Return the page as HTML text."""
    # Names of obstacles and nodes come from others: control characters are shown, HTML escaped.
    environment = Environment(
        loader=FileSystemLoader(STYLE_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        finalize=lambda value: printable(value) if type(value) is str else value,
    )
    style = ''.join(
        (STYLE_FOLDER / name).read_text(encoding='utf-8') for name in ('report.css', 'map.css')
    )
    return environment.get_template('report.html.jinja').render(
        report=report,
        style=Markup(style),
        map={'svg': Markup(map_svg(scene)), 'key': _map_key(scene)},
        plots=_plots(report, run),
        formula=_formula(),
    )


def _map_key(scene: Map) -> list[tuple[str, str]]:
    """Return the colours on the map, as CSS variables, and what they mean."""
    key = [
        ('given', 'given path and its waypoints'),
        ('band', f'within {scene.tolerance_m:g} m of it'),
        ('true', 'true path'),
        ('believed', 'believed path (odometry)'),
        ('error', 'error: between true and given'),
    ]
    key += [('bad', 'waypoint missed')] if scene.missed else []
    return key + ([('bad', 'collision, with its number below')] if scene.marks else [])


def _plots(report: Report, run: Run) -> list[dict[str, Any]]:
    begin, end = report.begin, report.end + 1
    if end - begin < 2:
        return []
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
    collision = [('bad', 'collision')] if touched else []
    return [
        {
            'title': 'Off the path, m over s',
            'note': 'to the left of it is positive',
            'svg': Markup(error.svg()),
            'key': [('band-good', f'within {FULL_TRACKING_M:.2f} m'), *collision],
        },
        {
            'title': 'Speed, m/s over s',
            'note': 'backwards is negative',
            'svg': Markup(speed.svg()),
            'key': [
                *(('given', 'asked'), ('believed', 'commanded'), ('true', 'true')),
                *collision,
            ],
        },
    ]


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
