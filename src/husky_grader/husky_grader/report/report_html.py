# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One page that shows a run: no network, no scripts, readable on a phone."""

from __future__ import annotations

from html import escape

from husky_course.printable import printable
from husky_grader.report.map_svg import map_svg
from husky_grader.report.plot_svg import MAX_POINTS, Plot
from husky_grader.report.report_style import STYLE
from husky_course.record import RunRecord
from husky_grader.report.map import Scene
from husky_grader.scoring.score_parts import FORMULA, FULL_TRACKING_M
from husky_grader.scoring.scoring import Report


def page(report: Report, run: RunRecord, scene: Scene) -> str:
    """Return the page as HTML text."""
    verdict = 'passed' if report.passed else 'not passed'
    css = 'good' if report.passed else 'bad'
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{_shown(report.course)}: {report.score:.1f}</title>'
        f'<style>{STYLE}</style></head><body>'
        f'<h1>{_shown(report.course)}</h1>'
        f'<div><span class="score">{report.score:.1f}</span> of 100, '
        f'<span class="{css}">{verdict}</span></div>'
        f'{_reasons(report)}{_map(scene)}{_parts(report)}{_figures(report)}'
        f'{_collisions(report)}{_disturbances(report)}{_plots(report, run)}'
        f'{_formula()}'
        f'<p class="soft hash">trajectory SHA-256 {report.trajectory_sha256}</p></body></html>\n'
    )


def _shown(text: str) -> str:
    """Return text of others as it can stand on a page."""
    return escape(printable(text))


def _reasons(report: Report) -> str:
    if not report.reasons:
        return ''
    items = ''.join(f'<li>{_shown(reason)}</li>' for reason in report.reasons)
    return f'<h2>What went wrong</h2><ul class="bad">{items}</ul>'


def _key(*entries: tuple[str, str]) -> str:
    spans = ''.join(
        f'<span><i style="background: var(--{colour})"></i>{text}</span>'
        for colour, text in entries
    )
    return f'<figcaption class="key">{spans}</figcaption>'


def _map(scene: Scene) -> str:
    entries = [
        ('given', 'given path and its waypoints'),
        ('band', f'within {scene.tolerance_m:g} m of it'),
        ('true', 'true path'),
        ('believed', 'believed path (odometry)'),
        ('error', 'error: between true and given'),
    ]
    entries += [('bad', 'waypoint missed')] if scene.missed else []
    entries += [('bad', 'collision, with its number below')] if scene.marks else []
    return f'<figure>{map_svg(scene)}{_key(*entries)}</figure>'


def _parts(report: Report) -> str:
    rows = ''.join(
        f'<tr><td>{part.name}</td><td class="n">x {part.factor:.3f}</td>'
        f'<td class="n">{part.cost_points:.1f}</td><td>{_shown(part.why)}</td></tr>'
        for part in report.parts
    )
    head = '<tr><th>part</th><th>factor</th><th>points lost</th><th>why</th></tr>'
    return f'<h2>Score</h2><table class="parts">{head}{rows}</table>'


def _figures(report: Report) -> str:
    clearance = report.min_clearance_m
    wall = report.wall_time_sec
    figures = {
        'waypoints reached': f'{report.waypoints_reached} of {report.waypoints_total}',
        'off the path, RMS': f'{report.cross_track_rms_m:.3f} m',
        'off the path, greatest': f'{report.cross_track_max_m:.3f} m',
        'nearest obstacle': 'none' if clearance is None else f'{clearance:.3f} m',
        'length of the path': f'{report.path_length_m:.2f} m',
        'driven': f'{report.driven_m:.2f} m',
        'time': f'{report.sim_time_sec:.2f} s',
        'wall time': '' if wall is None else f'{wall:.1f} s',
        'acceleration, RMS': f'{report.acceleration_rms_m_s2:.2f} m/s²',
        'yaw acceleration, RMS': f'{report.yaw_acceleration_rms_rad_s2:.2f} rad/s²',
    }
    rows = ''.join(
        f'<tr><td>{name}</td><td class="n">{value}</td></tr>'
        for name, value in figures.items()
        if value
    )
    return f'<h2>Figures</h2><table class="figures">{rows}</table>'


def _collisions(report: Report) -> str:
    if not report.collisions:
        return ''
    head = '<tr><th></th><th>obstacle</th><th>part</th><th>time</th><th>force</th></tr>'
    rows = ''.join(
        f'<tr><td>{number}</td><td>{_shown(touch.obstacle)}</td>'
        f'<td>{_shown(touch.part.replace("_", " "))}</td>'
        f'<td class="n">{touch.time_sec:.2f} s</td><td class="n">{touch.force_n:.0f} N</td></tr>'
        for number, touch in enumerate(report.collisions, 1)
    )
    return f'<h2>Collisions</h2><table>{head}{rows}</table>'


def _disturbances(report: Report) -> str:
    if not report.disturbances:
        return ''
    head = '<tr><th>time</th><th>topic</th><th>published by</th></tr>'
    rows = ''.join(
        f'<tr><td class="n">{entry.time_sec:.2f} s</td><td>{_shown(entry.topic)}</td>'
        f'<td>{_shown(", ".join(entry.nodes))}</td></tr>'
        for entry in report.disturbances
    )
    return f'<h2>Disturbances</h2><table>{head}{rows}</table>'


def _plots(report: Report, run: RunRecord) -> str:
    begin, end = report.begin, report.end + 1
    if end - begin < 2:
        return ''
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
    moment = [('bad', 'collision')] if touched else []
    error_key = _key(('band-good', f'within {FULL_TRACKING_M:.2f} m'), *moment)
    speed_key = _key(('given', 'asked'), ('believed', 'commanded'), ('true', 'true'), *moment)
    return (
        '<div class="plots"><section><h2>Off the path, m over s</h2>'
        '<p class="soft">to the left of it is positive</p>'
        f'<figure>{error.svg()}{error_key}</figure>'
        '</section><section><h2>Speed, m/s over s</h2>'
        f'<p class="soft">backwards is negative</p><figure>{speed.svg()}{speed_key}</figure>'
        '</section></div>'
    )


def _formula() -> str:
    """Return the formula as a list: a name begins an entry, deeper lines go on with it."""
    first, *lines = FORMULA.splitlines()
    entries: list[tuple[str, str]] = []
    for line in lines:
        if line[2] == ' ':
            entries[-1] = (entries[-1][0], f'{entries[-1][1]} {line.strip()}')
        else:
            name, text = line.split(maxsplit=1)
            entries.append((name, text))
    items = ''.join(f'<dt>{name}</dt><dd>{escape(text)}</dd>' for name, text in entries)
    return f'<h2>How the score is made</h2><p>{escape(first)}</p><dl>{items}</dl>'
