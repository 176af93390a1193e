# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One page that shows a run: no network, no scripts, readable on a phone."""

from __future__ import annotations

from html import escape

from husky_driver.run_record import RunRecord
from husky_driver.scene import Scene
from husky_driver.score_parts import FORMULA
from husky_driver.scoring import Report
from husky_driver.svg import map_svg, plot_svg

STYLE = """
:root { color-scheme: light dark; --ink: #1c2430; --soft: #667; --page: #fff; --line: #d5dae1;
  --given: #1f5fa8; --true: #22824a; --believed: #b87a00; --bad: #c62828; --solid: #9aa1ab; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ee; --soft: #9aa3b2; --page: #14181f;
  --line: #333b47; --given: #74aaf0; --true: #5fcf8f; --believed: #e8b04a; --bad: #ff7b72;
  --solid: #5b6472; } }
body { margin: 0 auto; padding: 1rem; max-width: 60rem; background: var(--page);
  color: var(--ink); font: 16px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.4rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 1.4rem 0 .4rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.score { font-size: 2.4rem; font-weight: 700; } .bad { color: var(--bad); }
.good { color: var(--true); } .soft, figcaption { color: var(--soft); font-size: .9rem; }
figure { margin: .5rem 0; } svg { width: 100%; height: auto; display: block; }
svg text { font: 14px system-ui, sans-serif; fill: var(--soft); }
svg polyline { fill: none; stroke-width: 2; stroke-linejoin: round; }
svg.map polyline { stroke-width: 4; } svg .grid { stroke: var(--line); }
svg .obstacle { fill: var(--solid); } svg .waypoint { fill: var(--given); }
svg .start { fill: var(--ink); } svg .mark { fill: var(--bad); }
svg polyline.band { stroke: var(--given); opacity: .22; stroke-linecap: round; }
svg .given { stroke: var(--given); } svg .true { stroke: var(--true); }
svg .believed { stroke: var(--believed); stroke-dasharray: 10 7; }
.key span { margin-right: 1rem; white-space: nowrap; } .key i { display: inline-block;
  width: 1.4rem; height: .25rem; margin-right: .35rem; vertical-align: middle; }
pre { white-space: pre-wrap; color: var(--soft); font-size: .8rem; }
.hash { overflow-wrap: anywhere; }
"""


def page(report: Report, run: RunRecord, scene: Scene) -> str:
    """Return the page as HTML text."""
    verdict = 'passed' if report.passed else 'not passed'
    css = 'good' if report.passed else 'bad'
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{escape(report.course)}: {report.score:.1f}</title>'
        f'<style>{STYLE}</style></head><body>'
        f'<h1>{escape(report.course)}</h1>'
        f'<div><span class="score">{report.score:.1f}</span> of 100, '
        f'<span class="{css}">{verdict}</span></div>'
        f'{_reasons(report)}{_map(scene)}{_parts(report)}{_figures(report)}'
        f'{_collisions(report)}{_plots(report, run)}'
        f'<h2>How the score is made</h2><pre>{escape(FORMULA)}</pre>'
        f'<p class="soft hash">trajectory SHA-256 {report.trajectory_sha256}</p></body></html>\n'
    )


def _reasons(report: Report) -> str:
    if not report.reasons:
        return ''
    items = ''.join(f'<li>{escape(reason)}</li>' for reason in report.reasons)
    return f'<h2>What went wrong</h2><ul class="bad">{items}</ul>'


def _key(*entries: tuple[str, str]) -> str:
    spans = ''.join(
        f'<span><i style="background: var(--{colour})"></i>{text}</span>'
        for colour, text in entries
    )
    return f'<figcaption class="key">{spans}</figcaption>'


def _map(scene: Scene) -> str:
    key = _key(
        ('given', f'given path, band {scene.tolerance_m:g} m'),
        ('true', 'true path'),
        ('believed', 'believed path (odometry)'),
        ('bad', 'collision'),
    )
    return f'<figure>{map_svg(scene)}{key}</figure>'


def _parts(report: Report) -> str:
    rows = ''.join(
        f'<tr><td>{part.name}</td><td class="n">x {part.factor:.3f}</td>'
        f'<td class="n">{part.cost_points:.1f}</td><td>{escape(part.why)}</td></tr>'
        for part in report.parts
    )
    head = '<tr><th>part</th><th>factor</th><th>points lost</th><th>why</th></tr>'
    return f'<h2>Score</h2><table>{head}{rows}</table>'


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
    return f'<h2>Figures</h2><table>{rows}</table>'


def _collisions(report: Report) -> str:
    if not report.collisions:
        return ''
    head = '<tr><th>obstacle</th><th>part</th><th>time</th><th>force</th></tr>'
    rows = ''.join(
        f'<tr><td>{escape(touch.obstacle)}</td><td>{escape(touch.part)}</td>'
        f'<td class="n">{touch.time_sec:.2f} s</td><td class="n">{touch.force_n:.0f} N</td></tr>'
        for touch in report.collisions
    )
    return f'<h2>Collisions</h2><table>{head}{rows}</table>'


def _plots(report: Report, run: RunRecord) -> str:
    begin, end = report.begin, report.end + 1
    if end - begin < 2:
        return ''
    times = run.time_sec[begin:end]
    error = plot_svg(times, [('true', report.errors_m[begin:end])], 'metres')
    speeds = [('given', run.command_speed_m_s[begin:end]), ('true', run.speed_m_s[begin:end])]
    return (
        f'<h2>Off the path, m over s (left of it is positive)</h2><figure>{error}</figure>'
        f'<h2>Speed, m/s over s</h2><figure>{plot_svg(times, speeds, "metres per second")}'
        f'{_key(("given", "commanded"), ("true", "true"))}</figure>'
    )
