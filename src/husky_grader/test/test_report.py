# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
import re
import xml.etree.ElementTree as ElementTree

from husky_course.outline import Outline
from husky_course.record import Collision, Disturbance, read_run, Record, Run
from husky_course.route import plan_route
from husky_course.waypoints import parse_course
from husky_grader.report.drawing import SIZE
from husky_grader.report.files import as_json, is_report, page, summary, write_report
from husky_grader.report.map import Map, map_svg, picture_svg, run_map, write_picture
from husky_grader.report.plot import Plot, ticks
from husky_grader.scoring.report import judge
import pytest

ROUTE = plan_route(parse_course('tolerance: 0.2\nwaypoints: [[0, 0], [2, 0], [4, 0]]'))
TOUCH = Collision(
    robot='husky',
    obstacle='a <cone>',
    part='front_left_wheel',
    time_sec=0.6,
    force_n=12.0,
    position=(1.0, 0.5, 0.1),
)
OTHER = Disturbance(time_sec=1.0, topic='odometry/filtered', nodes=('/<other>\x1b[2J',))


@pytest.fixture
def run(make_record: Callable[..., Record]) -> Run:
    """Return a run that leaves the path by half a metre in its middle, and touches a cone."""
    places = [(k / 50, min(k, 200 - k, 50) / 100) for k in range(201)]
    record = make_record(places + [places[-1]] * 10, collisions=[TOUCH], disturbances=[OTHER])
    return read_run(record)


@pytest.fixture
def scene(run: Run) -> Map:
    return run_map(run, ROUTE, judge(run, ROUTE))


def test_the_band_around_the_path_is_as_wide_as_the_tolerance(scene: Map) -> None:
    low_x, high_x, low_y, high_y = scene.near_bounds()
    a_metre = SIZE / max(high_x - low_x, high_y - low_y)
    (width,) = re.findall(r'class="band"[^>]*style="stroke-width: ([\d.]+)px"', map_svg(scene))
    assert float(width) == pytest.approx(2 * 0.2 * a_metre, abs=0.1)


def test_the_error_lies_between_true_and_given_path(scene: Map) -> None:
    half = len(scene.error) // 2
    there, back = scene.error[:half], scene.error[half:]
    assert max(y for _, y in there) == pytest.approx(0.5)
    assert max(abs(y) for _, y in back) == pytest.approx(0.0, abs=1e-6)
    assert back[0][0] > 3.9
    assert back[-1][0] < 0.1


def test_waypoints_and_collisions_are_numbered_as_in_the_text(scene: Map) -> None:
    drawing = map_svg(scene)
    assert re.findall(r'<text class="waypoint"[^>]*>(\d+)<', drawing) == ['1', '3']
    assert re.findall(r'<text class="missed"[^>]*>(\d+)<', drawing) == ['2']
    assert re.findall(r'<text class="hit"[^>]*>(\d+)<', drawing) == ['1']


def test_only_what_is_near_the_path_has_its_name_on_the_map(scene: Map) -> None:
    near = Outline(name='near', x=2.0, y=-1.5, yaw=0.0, size=(4.0, 1.0))
    part = replace(near, y=1.7)  # of the same obstacle, a little farther away
    far = Outline(name='far', x=2.0, y=-3.0, yaw=0.0, size=(0.3,))
    drawing = map_svg(replace(scene, obstacles=(far, part, near)))
    assert re.findall(r'<text class="name"[^>]*>(\w+)<', drawing) == ['near']


@pytest.mark.parametrize(('y_m', 'side'), [(-10.0, 'beneath'), (-21.0, 'above')])
def test_a_name_longer_than_its_obstacle_lies_beside_it(scene: Map, y_m: float, side: str) -> None:
    barrel = Outline(name='a barrel', x=2.0, y=y_m, yaw=0.0, size=(0.3,))
    downwards = replace(scene, obstacles=(barrel,), given=[(2.0, 0.0), (2.0, -10.0), (2.0, -20.0)])
    low_x, high_x, low_y, high_y = downwards.near_bounds()
    assert low_y < y_m < low_y + 0.6 or side == 'beneath', 'at the border there is no room beneath'
    a_metre = SIZE / max(high_x - low_x, high_y - low_y)
    (y,) = re.findall(r'<text class="name" x="[\d.]+" y="([\d.]+)"', map_svg(downwards))
    lower = float(y) - (high_y - y_m) * a_metre
    assert (lower > 0.3 * a_metre) if side == 'beneath' else (lower < -0.3 * a_metre)


def test_of_names_that_would_lie_over_each_other_the_nearest_is_shown(scene: Map) -> None:
    row = [Outline(name=f'barrel_{k}', x=k / 4, y=1.0, yaw=0.0, size=(0.1,)) for k in range(3)]
    apart = Outline(name='apart', x=1.0, y=-1.0, yaw=0.0, size=(0.1,))
    scene = replace(scene, obstacles=(*row, apart), given=[(0.5, 0.5)], true=[])
    drawing = map_svg(scene)
    assert re.findall(r'<text class="name"[^>]*>(\w+)<', drawing) == ['barrel_2', 'apart']


def test_the_axes_tell_where_the_path_is(scene: Map) -> None:
    drawing = map_svg(scene)
    found = re.findall(r'<text class="x axis" x="([\d.]+)"[^>]*>(-?\d+)<', drawing)
    at = {int(metres): float(place) for place, metres in found}
    given = re.findall(r'class="thin given" points="([\d.]+),', drawing)
    assert at[0] == pytest.approx(float(given[0]), abs=0.1)
    assert '>1 m</text>' in drawing, 'the bar that tells the scale'
    moved = map_svg(replace(scene, start=(1.0, 0.0, 0.0)))
    assert '>x of the world [m]</text>' in moved, 'a waypoint file has another frame there'


def test_a_picture_shows_its_title(scene: Map, tmp_path: Path) -> None:
    pictures = set()
    for title in ('one', 'two'):  # without a font both would be the same
        write_picture(replace(scene, title=title), tmp_path / 'path.png')
        pictures.add((tmp_path / 'path.png').read_bytes())
    assert len(pictures) == 2


def test_names_do_not_break_a_picture(scene: Map) -> None:
    cone = Outline(name='</title>\x1b', x=1.0, y=0.0, yaw=0.0, size=(0.3,))
    drawing = picture_svg(replace(scene, title='<b>\x07&', obstacles=(cone,)))
    texts = [element.text for element in ElementTree.fromstring(drawing.encode()).iter()]
    assert {r'<b>\x07&', r'</title>\x1b'} <= set(texts)


def test_the_page_holds_everything_and_loads_nothing(run: Run, tmp_path: Path) -> None:
    write_report(tmp_path, judge(run, ROUTE), run, ROUTE)
    page = (tmp_path / 'report.html').read_text()
    for part in ('given path', 'true path', 'believed path', 'error', 'collision', 'Speed'):
        assert part in page
    assert 'a &lt;cone&gt;' in page
    assert 'front left wheel' in page
    assert page.count('class="moment"') == 2  # the touch, in both plots
    assert '/&lt;other&gt;\\x1b[2J' in page
    assert '\x1b' not in page
    assert re.findall(r'(?:src|href)=|<script|@import|url\((?!#)', page) == []


def test_a_disturbance_is_in_every_form_of_the_report(run: Run) -> None:
    report = judge(run, ROUTE)
    assert as_json(report)['disturbances'] == [
        {'time_sec': 1.0, 'topic': 'odometry/filtered', 'nodes': ['/<other>\x1b[2J']}
    ]
    said = 'disturbed at 1.00 s: /<other>\\x1b[2J published odometry/filtered beside the simulator'
    first, *lines = summary(report).splitlines()
    assert first.endswith('NOT PASSED, score 0.0 of 100')
    assert [line.split(':')[0] for line in lines if said in line] == [
        f'  alone       x 0.000  costs {report.parts[-1].cost_points:4.1f}',
        '  ! disturbed at 1.00 s',
    ]
    content = as_json(report)
    assert content['score'] == 0.0
    assert content['parts'][-1]['name'] == 'alone'
    html = page(report, run, '', [])
    assert '<span class="score">0.0</span>' in html
    assert '<td>alone</td><td class="n">x 0.000</td>' in html


@pytest.mark.parametrize(
    'change', [{'score': 'all'}, {'reasons': [1]}, {'passed': 1}, {'parts': None}, {'more': 1}]
)
def test_what_has_not_the_shape_of_a_report_is_none(run: Run, change: dict[str, object]) -> None:
    content = as_json(judge(run, ROUTE))
    assert is_report(content)
    assert not is_report({**content, **change})
    assert not is_report({})


@pytest.mark.parametrize(
    ('low', 'high', 'expected'),
    [
        (0.0, 24.4, [0, 5, 10, 15, 20, 25]),
        (-0.12, 0.59, [-0.2, 0.0, 0.2, 0.4, 0.6]),
        (0.0, 0.05, [0.0, 0.01, 0.02, 0.03, 0.04, 0.05]),
        (3.0, 3.0, None),
    ],
)
def test_an_axis_has_round_numbers_that_enclose_the_values(
    low: float, high: float, expected: list[float] | None
) -> None:
    found = ticks(low, high)
    assert found[0] <= low + 1e-9
    assert found[-1] >= high - 1e-9
    if expected is not None:
        assert found == pytest.approx(expected)


def test_curves_stay_within_their_frame() -> None:
    plot = Plot('p', [0.0, 1.0, 2.0], {'true': [0.0, -3.0, 7.0]}, (-0.1, 0.1), [1.0]).svg()
    (points,) = re.findall(r'class="true" points="([^"]*)"', plot)
    places = [tuple(map(float, point.split(','))) for point in points.split()]
    assert all(46 <= x <= 468 and 10 <= y <= 172 for x, y in places)
