# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The map of a course or of a run, in the frame `world`, drawn once as SVG.

A page holds the part around the course; a picture (SVG or PNG) shows the whole world.
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

from husky_grader.report.drawing import axes, BOTTOM, Bounds, Drawing, LEFT, RIGHT, scale_bar, TOP
from husky_grader.report.names import names
from husky_grader.scoring.report import Report

MAX_POINTS = 750
MARGIN_M = 0.8
NEAR_M = 1.5  # around a course
MIN_SIZE_M = 8.0
DOT = 7.0
RAISED = 12.0  # a number beside its waypoint
MAX_NUMBERS = 60  # more could not be read
TITLE, LEGEND = 40.0, 55.0  # above and below the axes of a picture
PICTURE_WIDTH_PX = 770
FONT = 'Atkinson Hyperlegible Next'
FONT_FILE = '**/studio/assets/AtkinsonHyperlegibleNext*.ttf'
SYSTEM_FONT = 'DejaVu Sans'  # where MuJoCo has none
STYLE_FOLDER = Path(__file__).parent

Key = list[tuple[str, str]]
"""Colours, as CSS variables, and what they mean; 'dashed' stands behind that of a dashed line."""



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

    @property
    def frame(self) -> str:
        """Name the frame of the map where a waypoint file has another one."""
        return '' if self.start == (0.0, 0.0, 0.0) else 'the world'

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
    drawing = Drawing(scene.near_bounds())
    width, height = drawing.width + LEFT + RIGHT, drawing.height + TOP + BOTTOM
    frame = f'width="{drawing.width:.0f}" height="{drawing.height:.0f}"'
    parts = [*axes(drawing, scene.frame), '<g clip-path="url(#frame)">']
    parts += [*_elements(scene, drawing), '</g>', *scale_bar(drawing)]
    return (
        f'<svg class="map" viewBox="{-LEFT:.0f} {-TOP:.0f} {width:.0f} {height:.0f}" role="img" '
        f'aria-label="map of the run"><clipPath id="frame"><rect {frame}/></clipPath>'
        f'{"".join(parts)}<rect class="frame" {frame}/></svg>'
    )


def map_key(scene: Map) -> Key:
    """Return the colours on the map and what they mean."""
    key = [
        ('given', 'given path and its waypoints'),
        ('band', f'within {scene.tolerance_m:g} m of it'),
        ('true', 'true path'),
        ('believed dashed', 'believed path (odometry)'),
        ('error', 'error: between true and given'),
    ]
    key += [('bad', 'waypoint missed')] if scene.missed else []
    return key + ([('bad', 'collision, with its number below')] if scene.marks else [])


def picture_svg(scene: Map) -> str:
    """Return the map of the whole world as a file of its own: title, axes and legend."""
    drawing = Drawing(scene.bounds())
    top = TOP + TITLE
    width, height = drawing.width + LEFT + RIGHT, drawing.height + top + BOTTOM + LEGEND
    # To clip takes a fifth of the time for a picture.
    clip = '' if scene.is_within(scene.bounds()) else ' clip-path="url(#frame)"'
    parts = [*axes(drawing, scene.frame), f'<g{clip}>', *_elements(scene, drawing), '</g>']
    parts += [*scale_bar(drawing), *_legend(scene, drawing)]
    frame = f'width="{drawing.width:.0f}" height="{drawing.height:.0f}"'
    title = f'<text class="title" x="{drawing.width / 2:.0f}" y="-22">'
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" class="map" width="{PICTURE_WIDTH_PX}" '
        f'height="{PICTURE_WIDTH_PX * height / width:.0f}" '
        f'viewBox="{-LEFT:.0f} {-top:.0f} {width:.0f} {height:.0f}">'
        f'<style>{_picture_style()}</style><clipPath id="frame"><rect {frame}/></clipPath>'
        f'<rect class="page" x="{-LEFT:.0f}" y="{-top:.0f}" width="{width:.0f}" '
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


def _elements(scene: Map, drawing: Drawing) -> Iterator[str]:
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
    yield from names(scene.obstacles, [*scene.given, *scene.true], drawing)
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


def _legend(scene: Map, drawing: Drawing) -> Iterator[str]:
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
