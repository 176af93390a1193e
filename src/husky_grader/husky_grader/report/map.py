# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The map of a course or of a run, in the frame `world`, drawn once as SVG.

A page holds the part around the course; a picture (SVG or PNG) shows the whole world with axes.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from importlib.util import find_spec
import math
from pathlib import Path
import re

from husky_course.frames import Array, Pose, to_world
from husky_course.outline import Outline
from husky_course.printable import printable
from husky_course.record import Run
from husky_course.route import Point, Route
import numpy as np

from husky_grader.report.plot import ticks
from husky_grader.scoring.report import Report

MAX_POINTS = 750
MARGIN_M = 0.8
NEAR_M = 1.5  # around a course
MIN_SIZE_M = 8.0
SIZE = 1000.0  # the longer side, in units of the drawing
DOT = 7.0
RAISED = 12.0  # a number beside its waypoint
MAX_NUMBERS = 60  # more could not be read
LEFT, RIGHT, TOP, BOTTOM = 90.0, 20.0, 60.0, 130.0  # around the map of a picture
PICTURE_WIDTH_PX = 770
FONT = 'Atkinson Hyperlegible Next'
FONT_FILE = '**/studio/assets/AtkinsonHyperlegibleNext*.ttf'
SYSTEM_FONT = 'DejaVu Sans'  # where MuJoCo has none
STYLE_FOLDER = Path(__file__).parent

Key = list[tuple[str, str]]  # colours, as CSS variables, and what they mean
Bounds = tuple[float, float, float, float]  # least and greatest x and y, in metres


@dataclass(frozen=True, kw_only=True)
class Map:
    """Everything on a map; lines are lists of points in metres."""

    title: str
    obstacles: tuple[Outline, ...]
    given: list[Point]
    waypoints: list[Point]
    tolerance_m: float
    start: Pose
    true: list[Point]
    believed: list[Point]
    marks: list[Point]  # collisions, or places that are too near to something
    missed: frozenset[int] = frozenset()  # numbers of waypoints
    error: tuple[Point, ...] = ()  # outline of what lies between the true and the given path

    def near_bounds(self) -> Bounds:
        """Return the bounds of the course and the run, not less than MIN_SIZE_M wide."""
        points = [*self.given, *self.true, *self.believed, *self.marks, self.start[:2]]
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return (*_widened(min(xs), max(xs)), *_widened(min(ys), max(ys)))

    def bounds(self) -> Bounds:
        """Return the bounds of the whole world, with a margin."""
        points = [*self.given, *self.true, self.start[:2]]
        for outline in self.obstacles:
            points += _corners(outline)
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        return min(xs) - MARGIN_M, max(xs) + MARGIN_M, min(ys) - MARGIN_M, max(ys) + MARGIN_M

    def is_within(self, bounds: Bounds) -> bool:
        """Tell whether nothing is drawn outside; also odometry that has gone astray."""
        low_x, high_x, low_y, high_y = bounds
        points = [*self.believed, *self.marks, *self.error]
        return all(low_x <= x <= high_x and low_y <= y <= high_y for x, y in points)


def course_map(
    route: Route,
    obstacles: tuple[Outline, ...],
    start: Pose = (0.0, 0.0, 0.0),
    marks: Sequence[Point] = (),
) -> Map:
    """Return the map of a course."""
    course, curve = route.course, route.curve
    return Map(
        title=course.name,
        obstacles=obstacles,
        given=_thinned([to_world(start, x, y) for x, y in zip(curve.x, curve.y, strict=True)]),
        waypoints=[to_world(start, point.x_m, point.y_m) for point in course.waypoints],
        tolerance_m=course.tolerance_m,
        start=start,
        true=[],
        believed=[],
        marks=list(marks),
    )


def run_map(run: Run, route: Route, report: Report) -> Map:
    """Return the map of a run."""
    seen = run.spread(MAX_POINTS)
    beside = run.spread(MAX_POINTS, report.begin, report.end + 1)
    asked = np.array([route.curve.point_at(along) for along in report.along_m[beside]])
    missed = [i for i, got in enumerate(report.visits) if not got]  # a loop's last is its first
    return replace(
        course_map(route, run.obstacles, run.start),
        true=_points(*run.to_world(run.x[seen], run.y[seen])),
        believed=_points(*run.to_world(run.odom_x[seen], run.odom_y[seen])),
        marks=[touch.position[:2] for touch in run.collisions],
        missed=frozenset(i % len(route.course.waypoints) for i in missed),
        error=(
            *_points(*run.to_world(run.x[beside], run.y[beside])),
            *_points(*run.to_world(asked[:, 0], asked[:, 1]))[::-1],
        ),
    )


def map_svg(scene: Map) -> str:
    """Return the part of the map around the course, for a page with its style."""
    drawing = _Drawing(scene.near_bounds())
    return (
        f'<svg class="map" viewBox="0 0 {drawing.width:.0f} {drawing.height:.0f}" role="img" '
        f'aria-label="map of the run">{"".join(_elements(scene, drawing))}</svg>'
    )


def map_key(scene: Map) -> Key:
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


def picture_svg(scene: Map) -> str:
    """Return the map of the whole world as a file of its own: title, axes and legend."""
    drawing = _Drawing(scene.bounds())
    width, height = drawing.width + LEFT + RIGHT, drawing.height + TOP + BOTTOM
    # To clip takes a fifth of the time for a picture.
    clip = '' if scene.is_within(scene.bounds()) else ' clip-path="url(#frame)"'
    parts = [*_axes(drawing), f'<g{clip}>', *_elements(scene, drawing), '</g>']
    parts += _legend(scene, drawing)
    frame = f'width="{drawing.width:.0f}" height="{drawing.height:.0f}"'
    title = f'<text class="title" x="{drawing.width / 2:.0f}" y="-22">'
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" class="map" width="{PICTURE_WIDTH_PX}" '
        f'height="{PICTURE_WIDTH_PX * height / width:.0f}" '
        f'viewBox="{-LEFT:.0f} {-TOP:.0f} {width:.0f} {height:.0f}">'
        f'<style>{_picture_style()}</style><clipPath id="frame"><rect {frame}/></clipPath>'
        f'<rect class="page" x="{-LEFT:.0f}" y="{-TOP:.0f}" width="{width:.0f}" '
        f'height="{height:.0f}"/>{title}{escape(printable(scene.title))}</text>'
        f'{"".join(parts)}<rect class="frame" {frame}/></svg>\n'
    )


def write_picture(scene: Map, path: Path) -> None:
    """Write the map of the whole world to a file; its ending, .svg or .png, tells the format."""
    drawing = picture_svg(scene)
    if path.suffix == '.svg':
        path.write_text(drawing, encoding='utf-8')
        return
    from resvg_py import svg_to_bytes

    fonts = _fonts()
    path.write_bytes(
        svg_to_bytes(
            drawing,
            font_files=fonts,
            sans_serif_family=FONT if fonts else SYSTEM_FONT,
            skip_system_fonts=bool(fonts),
        )
    )


class _Drawing:
    """Scales metres to units of the drawing, y upwards."""

    def __init__(self, bounds: Bounds) -> None:
        self.bounds = bounds
        low_x, high_x, low_y, high_y = bounds
        self.scale = SIZE / max(high_x - low_x, high_y - low_y)
        self.width, self.height = self.at((high_x, low_y))

    def at(self, point: Sequence[float]) -> Point:
        low_x, _, _, high_y = self.bounds
        return (point[0] - low_x) * self.scale, (high_y - point[1]) * self.scale


def _elements(scene: Map, drawing: _Drawing) -> Iterator[str]:
    """Yield what both kinds of drawing show, from the back to the front."""

    def line(kind: str, css: str, points: Sequence[Point], more: str = '') -> str:
        path = ' '.join('{:.1f},{:.1f}'.format(*drawing.at(point)) for point in points)
        return f'<{kind} class="{css}" points="{path}"{more}' if points else ''

    for outline in scene.obstacles:
        name = escape(printable(outline.name))
        yield line('polygon', 'obstacle', _corners(outline)) + f'><title>{name}</title></polygon>'
    band_width = 2 * scene.tolerance_m * drawing.scale
    lines = [
        line('polyline', 'band', scene.given, f' style="stroke-width: {band_width:.1f}px"'),
        line('polyline', 'thin given', scene.given),
        line('polygon', 'error', scene.error),
        line('polyline', 'thin believed', scene.believed),
        line('polyline', 'thin true', scene.true),
    ]
    yield from (f'{element}/>' for element in lines if element)
    yield _dot('start', drawing.at(scene.start), 1.6 * DOT)
    for number, point in enumerate(scene.waypoints):
        css = 'missed' if number in scene.missed else 'waypoint'
        yield _dot(css, drawing.at(point), DOT)
        if len(scene.waypoints) <= MAX_NUMBERS:
            yield _number(css, number, drawing.at(point), RAISED)
    for number, point in enumerate(scene.marks):
        yield _dot('mark', drawing.at(point), 2.2 * DOT)
        yield _number('hit', number, drawing.at(point), 0.0)


def _dot(css: str, place: Point, radius: float) -> str:
    return f'<circle class="{css}" cx="{place[0]:.1f}" cy="{place[1]:.1f}" r="{radius:.1f}"/>'


def _number(css: str, number: int, place: Point, raised: float) -> str:
    x, y = place[0] + raised, place[1] - raised
    return f'<text class="{css}" x="{x:.1f}" y="{y:.1f}">{number + 1}</text>'


def _axes(drawing: _Drawing) -> Iterator[str]:
    """Yield a grid in metres with its numbers."""
    low_x, high_x, low_y, high_y = drawing.bounds
    width, height = drawing.width, drawing.height
    for value in ticks(low_x, high_x)[1:-1]:
        x, _ = drawing.at((value, 0.0))
        yield f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="0" y2="{height:.1f}"/>'
        yield f'<text class="x axis" x="{x:.1f}" y="{height + 28:.1f}">{value:g}</text>'
    for value in ticks(low_y, high_y)[1:-1]:
        _, y = drawing.at((0.0, value))
        yield f'<line class="grid" x1="0" x2="{width:.1f}" y1="{y:.1f}" y2="{y:.1f}"/>'
        yield f'<text class="y axis" x="-12" y="{y + 7:.1f}">{value:g}</text>'
    yield f'<text class="x axis" x="{width / 2:.1f}" y="{height + 58:.1f}">x [m]</text>'
    turned = f'transform="rotate(-90 -62 {height / 2:.1f})"'
    yield f'<text class="x axis" x="-62" y="{height / 2:.1f}" {turned}>y [m]</text>'


def _legend(scene: Map, drawing: _Drawing) -> Iterator[str]:
    """Yield a row under the axes that explains what is on the map."""
    entries = {'given': ('given path', bool(scene.given)), 'true': ('true path', bool(scene.true))}
    entries['believed'] = ('believed (odometry)', bool(scene.believed))
    entries['start'] = ('start', True)
    entries['missed'] = ('missed', bool(scene.missed))
    entries['mark'] = ('touched', bool(scene.marks))
    x, y = 0.0, drawing.height + 98.0
    for css, (text, shown) in entries.items():
        if not shown:
            continue
        is_line = css in ('given', 'true', 'believed')
        if is_line:
            yield f'<polyline class="thin {css}" points="{x},{y} {x + 44},{y}"/>'
        else:
            yield _dot(css, (x + 6, y), 1.6 * DOT)
        x += 54 if is_line else 26
        yield f'<text class="legend" x="{x:.0f}" y="{y + 8:.0f}">{text}</text>'
        x += 30 + 10 * len(text)


def _picture_style() -> str:
    """Return the style of the map with the colours of the page's light theme in their places."""
    light = (STYLE_FOLDER / 'report.css').read_text(encoding='utf-8').split('}')[0]
    colours = dict(re.findall(r'--([\w-]+): ([^;]+);', light))
    style = (STYLE_FOLDER / 'map.css').read_text(encoding='utf-8')
    return re.sub(r'var\(--([\w-]+)\)', lambda match: colours[match[1]], style)


def _fonts() -> list[str]:
    """Return the font that MuJoCo brings for its studio, so that numbers look alike everywhere."""
    found = find_spec('mujoco')
    folders = (found.submodule_search_locations if found else None) or []
    files = (file for name in folders for file in Path(name).glob(FONT_FILE))
    return [str(file) for file in sorted(files)[:1]]


def _widened(low: float, high: float) -> tuple[float, float]:
    more = max(NEAR_M, (MIN_SIZE_M - (high - low)) / 2)
    return low - more, high + more


def _corners(outline: Outline) -> list[Point]:
    """Return the corners of a rectangle, or of a polygon around a circle."""
    if outline.type == 'circle':
        (radius,) = outline.size
        turns = [k * math.pi / 12 for k in range(24)]
        return [
            (outline.x + radius * math.cos(a), outline.y + radius * math.sin(a)) for a in turns
        ]
    lx, ly = outline.size[0] / 2, outline.size[1] / 2
    pose = (outline.x, outline.y, outline.yaw)
    return [to_world(pose, x, y) for x, y in ((lx, ly), (-lx, ly), (-lx, -ly), (lx, -ly))]


def _thinned(points: Sequence[Point]) -> list[Point]:
    """Leave points out where there are too many to see."""
    every = max(1, -(-len(points) // MAX_POINTS))
    return [*points[:-1:every], points[-1]] if points else []


def _points(x: Array, y: Array) -> list[Point]:
    return list(zip(x.tolist(), y.tolist(), strict=True))
