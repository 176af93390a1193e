# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import json
import math
import os
from pathlib import Path
import re
from tempfile import TemporaryDirectory
import time
from typing import Any

from husky_course.checked_yaml import FileRefused, Problem
from husky_course.route import plan_route, plan_speeds
from husky_course.waypoints.course import Course
from husky_course.waypoints.schema import schema_text
from husky_course.waypoints.waypoint_file import load_course, parse_course
from hypothesis import given, settings
from hypothesis import strategies as st
import jsonschema
import pytest
import yaml

# For ten thousand: GENERATED_FILES=10000 ./lab test src/husky_course/test/test_waypoints.py
GENERATED_FILES = int(os.environ.get('GENERATED_FILES', '200'))


def problems(text: str) -> list[str]:
    with pytest.raises(FileRefused) as refused:
        parse_course(text, 'course.yaml')
    return str(refused.value).splitlines()


def test_a_complete_file_becomes_the_course_it_describes() -> None:
    course = parse_course(
        'frame: odom\nspeed: 0.8\ntolerance: 0.3\nloop: true\ncorners: sharp\nwaypoints:\n'
        '  - [1.3, -1.2]\n  - {x: 2.7, y: -2.6, speed: 0.5, reverse: true}\n'
        '  - {x: 3, y: 1e0, yaw: 1.5, dwell: 2}\n'
    )
    assert (course.speed_m_s, course.tolerance_m, course.loop) == (0.8, 0.3, True)
    assert course.corners == 'sharp'
    first, second, third = course.waypoints
    assert (first.x_m, first.y_m, first.line) == (1.3, -1.2, 7)
    assert (second.speed_m_s, second.reverse) == (0.5, True)
    assert (third.y_m, third.yaw_rad, third.dwell_sec) == (1.0, 1.5, 2.0)
    assert course.stops == (first, second, third, first)


def test_every_course_is_valid_and_as_long_as_it_says(courses: Path) -> None:
    loaded = {path: load_course(path) for path in courses.glob('*.yaml')}
    assert {'central_barrier', 'straight'} <= {course.name for course in loaded.values()}
    told = {path: re.search(r'about (\d+) m', path.read_text()) for path in loaded}
    assert {path.stem: int(found[1]) for path, found in told.items() if found} == {
        path.stem: round(plan_route(loaded[path]).length_m)
        for path, found in told.items()
        if found
    }
    assert len(loaded) - list(told.values()).count(None) == 5


def test_every_mistake_of_a_file_is_named_at_once_with_its_line() -> None:
    assert problems(
        'spede: 0.5\nspeed: 1.4\nloop: yes\nframe: map\nwaypoints:\n  - [1,2, 3,4]\n'
        '  - {x: 1, yaw: 90}\n'
    ) == [
        'course.yaml: line 1, column 1: spede is no field; did you mean speed? '
        'allowed: frame, speed, tolerance, loop, corners, waypoints',
        'course.yaml: line 2, column 8: speed: 1.4 is out of range; allowed is 0.05 to 1 m/s',
        'course.yaml: line 3, column 7: loop: yes is not allowed; write true or false; '
        'did you mean true?',
        'course.yaml: line 4, column 8: frame: map is not allowed; allowed: odom',
        'course.yaml: line 6, column 5: waypoints[0]: 4 values instead of 2; '
        'write [x, y], with a decimal point and not a comma',
        'course.yaml: line 7, column 5: waypoints[1].y: missing; every waypoint needs x and y',
        'course.yaml: line 7, column 17: waypoints[1].yaw: 90 is out of range; '
        'allowed is -6.2832 to 6.2832 rad; 90 degrees would be 1.5708',
    ]


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('', 'line 1, column 1: nothing instead of a waypoint file'),
        ('speed: 1', 'line 1, column 1: waypoints: missing'),
        ('waypoints: 5', 'line 1, column 12: waypoints: 5 instead of a list'),
        ('waypoints: [[0, 0]]', 'line 1, column 12: waypoints: 1 given; allowed are 2 to 1000'),
        ('waypoints: [[0, 0, 0]]', 'column 13: waypoints[0]: 3 values instead of 2'),
        (
            'waypoints: [[0, 0], [.nan, 1]]',
            'column 22: waypoints[1].x: .nan is not a number',
        ),
        (
            'waypoints: [[0, 0], [.inf, 1]]',
            'column 22: waypoints[1].x: .inf is not a number',
        ),
        (
            'waypoints: [[0, 0], [1e999, 1]]',
            'column 22: waypoints[1].x: 1e999 is out of range',
        ),
        (
            'waypoints: [[0, 0], [true, 1]]',
            'column 22: waypoints[1].x: true is not a number',
        ),
        ('waypoints: [[0, 0], ["3", 1]]', "waypoints[1].x: '3' is not a number (a number without"),
        ('waypoints: [[0, 0], [0x1, 1]]', 'waypoints[1].x: 0x1 is not a number; allowed'),
        ('waypoints: [[0, 0], [\u22123, 1]]', 'is not a number (write -3, with the minus'),
        ('waypoints: [[0, 0], [3m, 1]]', 'waypoints[1].x: 3m is not a number (write 3, without'),
        (
            'waypoints: [[0, 0], [0, 0.01]]',
            'waypoints[1]: 0.010 m from waypoints[0]; at least 0.05 m',
        ),
        ('loop: true\nwaypoints: [[0, 0], [1, 0]]', 'waypoints: 2 given; a loop needs at least 3'),
        (
            'loop: true\nwaypoints: [[0, 0], [1, 0], [0, 0]]',
            'waypoints[2]: 0.000 m from waypoints[0]; at least 0.05 m; leave it out, a loop comes '
            'back by itself',
        ),
        (
            'waypoints: [[0, 0], {x: 1, y: 0, loop: true}]',
            'waypoints[1]: loop is no field; allowed: x, y, speed, yaw, dwell, reverse',
        ),
        ('speed: -0.5\nwaypoints: [[0, 0], [1, 0]]', 'to drive backwards write reverse: true'),
        (
            'speed: 0.5\nspeed: 0.6\nwaypoints: [[0, 0], [1, 0]]',
            'line 2, column 1: speed: given',
        ),
        ('waypoints: &a [*a]', "line 1, column 12: anchor '&a' is not allowed"),
        ('a: *b', "line 1, column 4: alias '*b' is not allowed"),
        ('waypoints: !!python/tuple [1]', 'line 1, column 12: tag'),
        ('waypoints: [[0, 0], [1, 0]]\n---\na: 1', "line 2, column 1: a second document ('---')"),
        ('waypoints:\n\t- [0, 0]', 'line 2, column 1: a tab (U+0009); write plain spaces'),
        ('[' * 50_000, 'line 1, column 9: nested deeper than 8 levels'),
        ('a: \x00', 'line 1, column 4: character U+0000 is not allowed'),
        ('waypoints: [[0, 0], [999, 0], [-999, 0]]', '2997 m from first to last'),
    ],
)
def test_a_mistake_is_refused_with_place_and_allowed_values(text: str, expected: str) -> None:
    assert any(expected in line for line in problems(text))


@pytest.mark.parametrize('line_break', ['\n', '\r\n', '\r', '\x85', '\u2028', '\u2029'])
@pytest.mark.parametrize(
    ('lines', 'expected'),
    [
        (['speed: 0.5', 'loop true', 'waypoints:'], 'line 2, column 5: a colon is missing'),
        (['speed: 0.5', 'waypoints: [[0, 0], [1, 0]', 'a: 1'], 'line 2, column 12: the [ has no'),
        (['a:', 'b'], 'line 2, column 2: not valid YAML'),
        (['speed: 0.5', 'title: \x07'], 'line 2, column 8: character U+0007 is not allowed'),
    ],
)
def test_a_mistake_has_the_same_place_with_any_line_break(
    line_break: str, lines: list[str], expected: str
) -> None:
    assert expected in problems(line_break.join(lines))[0]


ITEMS = '  - [0, 0]\n  - [1, 0]\n'
COURSE = f'waypoints:\n{ITEMS}'
SAME = 'write both in the same column'


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        (
            f'{COURSE}<<<<<<< HEAD\n  - [2, 0]\n=======\n  - [3, 0]\n>>>>>>> theirs\n',
            '4, column 1: a merge conflict of git begins here; keep one of its two sides, and '
            'remove the lines that begin with <<<<<<<, ======= and >>>>>>>',
        ),
        (f'frame odom\n{COURSE}', "1, column 6: a colon is missing; write 'frame: odom'"),
        (
            f'loop: true\nframe odom\n{COURSE}',
            "2, column 6: a colon is missing; write 'frame: odom'",
        ),
        (f'speed = 0.5\n{COURSE}', "1, column 6: a colon is missing; write 'speed: 0.5'"),
        (
            f'loop: true\nspeed:0.5\n{COURSE}',
            "2, column 7: a space is missing; write 'speed: 0.5'",
        ),
        (
            'waypoints:\n  -{x: 0, y: 0}\n',
            "2, column 4: a space is missing; write '- {x: 0, y: 0}'",
        ),
        (f'{COURSE}speed:0.5\n', "4, column 7: a space is missing; write 'speed: 0.5'"),
        (
            f'frame: odom speed: 1\n{COURSE}',
            '1, column 13: speed is a second field in this line; give it a line of its own, or',
        ),
        (
            f'frame: odom\n  speed: 0.5\n{COURSE}',
            f'2, column 3: speed stands in column 3, but frame of line 1 in column 1; {SAME}',
        ),
        (
            f' frame: odom\nspeed: 1\n{COURSE}',
            '1, column 2: begins in column 2; begin in column 1',
        ),
        (
            f'{COURSE}    - [2, 0]\n',
            f'4, column 5: the dash stands in column 5, but that of line 3 in column 3; {SAME}',
        ),
        (
            f'{COURSE}- [2, 0]\n',
            f'4, column 1: the dash stands in column 1, but that of line 3 in column 3; {SAME}',
        ),
        (
            'waypoints:\n  - x: 0\n    y: 0\n  - x: 1  # far\n   y: 0\n',
            f'5, column 4: y stands in column 4, but x of line 4 in column 5; {SAME}',
        ),
        ('waypoints:\n  [0, 0]\n  [1, 0]\n', "2, column 3: a dash is missing; write '- [0, 0]'"),
        (
            f'speed:\u00a00.5\n{COURSE}',
            '1, column 7: a no-break space (U+00A0); write plain spaces',
        ),
        ('waypoints:\n  - [0, 0\n  - [1, 0]\n', '2, column 5: the [ has no ] in this line'),
        ('waypoints:\n  - {x: 0 y: 0}\n', '2, column 12: a comma or the } is missing before this'),
        (f'frame: "odom\n{COURSE}', '1, column 8: the " that begins here has no end'),
    ],
)
def test_a_broken_layout_is_told_where_a_person_broke_it(text: str, expected: str) -> None:
    (line,) = problems(text)
    assert line.startswith(f'course.yaml: line {expected}')


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        (f'speed: -0.5\n{COURSE}', '; to drive backwards write reverse: true into a waypoint'),
        (f'{COURSE}  - {{x: 2, y: 0, speed: -1}}', '; to drive backwards write reverse: true'),
        (f'reverse: true\n{COURSE}', 'it belongs into a waypoint: {x: .., y: .., reverse: ..}'),
        (
            f'{COURSE}  - [2, 0, 0.0]',
            '3 values instead of 2; write [x, y], without z: the ground ',
        ),
        (f'{COURSE}  - [2,5, 0]', 'write [x, y], without z, and with a decimal point and not a '),
        (f'{COURSE}  - [2 0]', '1 value instead of 2; write [x, y], with a comma between them'),
        (f'{COURSE}  - {{x: 2, y:0}}', "y:0 is no field; write 'y: 0', with a space"),
        ('waypoints:\n  -[0, 0]\n', 'write a space after the dash'),
        (f'{COURSE}  - [2,\u00a00]', 'it has a no-break space (U+00A0): write a plain space'),
    ],
)
def test_a_value_that_means_something_else_is_told_what(text: str, expected: str) -> None:
    assert any(expected in line for line in problems(text))


def test_a_number_of_80_kB_is_refused_at_once() -> None:
    (line,) = problems(f'waypoints: [[0, 0], [{"1" * 80_000}!, 1]]')
    assert '... is not a number; ' in line


def test_a_file_that_cannot_be_read_is_refused_with_the_reason(tmp_path: Path) -> None:
    (tmp_path / 'square.yaml').write_bytes(b'speed: \xff')
    (tmp_path / 'mine.yaml.txt').touch()
    (tmp_path / 'large.yaml').write_bytes(b'#' * 200_000)
    for path, reason in {
        'square.yaml': 'line 1, column 8: byte 0xff is not UTF-8',
        'large.yaml': 'line 1, column 1: larger than 100000 bytes',
        'squre.yaml': r'squre.yaml: no such file; did you mean .*square.yaml',
        'mine.yaml': r'mine.yaml: no such file; did you mean .*mine.yaml.txt\?',
        '.': f'{tmp_path}: not a file',
        'nul\0': 'cannot be read|no such file',
    }.items():
        with pytest.raises(FileRefused, match=reason):
            load_course(tmp_path / path)


@pytest.mark.parametrize(
    'text', ['speed: *{}', 'speed: &{} 1', 'speed: !{} 1', 'a: {}: 1', '{} = 5\nb: 2\n c: [']
)
def test_a_very_long_word_does_not_fill_the_terminal(text: str) -> None:
    (line,) = problems(text.format('a' * 90_000))
    assert line.endswith('aaa...')
    assert len(line) < 1100


def test_waypoints_may_be_as_close_as_the_message_allows() -> None:
    points = ', '.join(f'[{k / 20}, 0]' for k in range(100))  # as in binary: some 1e-17 m closer
    assert len(parse_course(f'waypoints: [{points}]').waypoints) == 100
    with pytest.raises(ValueError, match=r'waypoints\[1\]: 0.050 m from'):
        parse_course('waypoints: [[0, 0], [0.0499999, 0]]')


def test_the_first_waypoint_has_no_yaw_and_no_dwell() -> None:
    text = 'waypoints:\n  - {x: 0, y: 0, yaw: 0, dwell: 3}\n  - [2, 0]\n  - [2, 2]\n'
    why = 'not for the first waypoint, where the drive begins; leave it out'
    assert problems(text) == [
        f'course.yaml: line 2, column 1: waypoints[0].dwell: {why}',
        f'course.yaml: line 2, column 1: waypoints[0].yaw: {why}',
    ]
    assert parse_course(f'loop: true\n{text}').stops[-1].dwell_sec == 3.0
    assert parse_course('waypoints: [{x: 0, y: 0, dwell: 0}, [2, 0]]').stops[0].dwell_sec == 0.0


def test_a_file_does_not_dwell_for_days() -> None:
    pause = '  - {x: %d, y: 0, dwell: 600}\n'
    text = 'waypoints:\n  - [0, 0]\n' + ''.join(pause % x for x in range(1, 7))
    assert sum(stop.dwell_sec for stop in parse_course(text).stops) == 3600.0
    assert problems(text + pause % 7) == [
        'course.yaml: line 2, column 1: waypoints: 4200 s of dwell in all; allowed is up to 3600 s'
    ]


def test_a_link_to_nothing_is_refused_with_where_it_leads(tmp_path: Path) -> None:
    for name, target in {
        'dangling.yaml': '/nowhere/square.yaml',
        'self.yaml': 'self.yaml',
    }.items():
        (tmp_path / name).symlink_to(target)
        said = f"{name}: a link to '{target}', where no file is; give the file itself$"
        with pytest.raises(FileRefused, match=said):
            load_course(tmp_path / name)


@pytest.fixture
def schema(courses: Path) -> Any:
    text = (courses.parent / 'waypoints.schema.json').read_text()
    return jsonschema.Draft202012Validator(json.loads(text))


def test_the_schema_is_made_from_the_table(courses: Path) -> None:
    file = courses.parent / 'waypoints.schema.json'
    command = './lab exec python3 -m husky_course.waypoints.schema > config/waypoints.schema.json'
    assert file.read_text() == schema_text(), f'run: {command}'


def test_the_schema_for_editors_accepts_every_course_of_the_lab(
    courses: Path, schema: Any
) -> None:
    jsonschema.Draft202012Validator.check_schema(schema.schema)
    for path in courses.glob('*.yaml'):
        assert list(schema.iter_errors(yaml.safe_load(path.read_text()))) == []


@pytest.mark.parametrize(
    'text',
    [
        'speed: 1.4\nwaypoints: [[0, 0], [1, 0]]',
        'frame: map\nwaypoints: [[0, 0], [1, 0]]',
        'waypoints: [[0, 0], [1, 0, 2]]',
        'waypoints: [[0, 0], {x: 1}]',
        'waypoints: [[0, 0], {x: 1, y: 2, yaw: 90}]',
        'waypoints: [[0, 0], {x: 1, y: 2, z: 3}]',
        'waypoints: [[0, 0]]',
        'corners: round\nwaypoints: [[0, 0], [1, 0]]',
        'tolerance: 0\nwaypoints: [[0, 0], [1, 0]]',
        'spede: 1\nwaypoints: [[0, 0], [1, 0]]',
        'speed: 0.5',
    ],
)
def test_the_schema_refuses_what_the_driver_refuses(schema: Any, text: str) -> None:
    assert problems(text)
    assert list(schema.iter_errors(yaml.safe_load(text)))


scalars = st.one_of(
    st.floats().map(str),
    st.integers().map(str),
    st.sampled_from(['true', '~', '', '.nan', '-.inf', '1e999', '&a 1', '*a', '!!int 3', '- -']),
    st.text(max_size=12),
)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4).map(lambda items: f'[{", ".join(items)}]'),
        st.lists(st.tuples(scalars, inner), max_size=3).map(
            lambda pairs: '{' + ', '.join(f'{key}: {value}' for key, value in pairs) + '}'
        ),
    ),
    max_leaves=12,
)
keys = st.sampled_from(
    ['frame', 'speed', 'tolerance', 'loop', 'corners', 'waypoints', 'spede', '', '?', '-']
)
coordinates = st.floats(-60, 60, allow_nan=False).map(repr)
likely_points = st.one_of(
    st.tuples(coordinates, coordinates).map(lambda point: f'[{point[0]}, {point[1]}]'),
    st.tuples(coordinates, coordinates, st.floats(0.05, 1.0), st.booleans()).map(
        lambda p: f'{{x: {p[0]}, y: {p[1]}, speed: {p[2]:.3f}, reverse: {str(p[3]).lower()}}}'
    ),
    st.tuples(coordinates, coordinates, st.floats(-7, 7), st.floats(0, 9)).map(
        lambda p: f'{{x: {p[0]}, y: {p[1]}, yaw: {p[2]}, dwell: {p[3]}}}'
    ),
)
likely_courses = st.tuples(
    st.sampled_from(['', 'loop: true\n', 'corners: sharp\n', 'tolerance: 0.1\n']),
    st.lists(likely_points, min_size=2, max_size=8),
).map(lambda course: course[0] + 'waypoints:\n' + '\n'.join(f'  - {p}' for p in course[1]))
enormous = st.one_of(
    st.integers(0, 3000).map(lambda count: 'waypoints:\n' + '  - [1, 2]\n' * count),
    st.tuples(st.sampled_from(['[', '{a: ', '- ', '"', '\n', ' ', '?']), st.integers(1, 9999)).map(
        lambda repeated: repeated[0] * repeated[1]
    ),
)
documents = st.one_of(
    likely_courses,
    st.tuples(likely_courses, st.sampled_from(['\r', '\x85', '\u2028']), st.text(max_size=4)).map(
        lambda course: course[0].replace('\n', course[1]) + course[2]
    ),
    enormous,
    st.text(),
    st.binary(),
    values,
    st.lists(st.tuples(keys, values), max_size=6).map(
        lambda pairs: '\n'.join(f'{key}: {value}' for key, value in pairs)
    ),
    st.lists(st.tuples(values, values), min_size=2, max_size=6).map(
        lambda points: 'waypoints:\n' + '\n'.join(f'  - [{x}, {y}]' for x, y in points)
    ),
)


@pytest.mark.timeout(120 + GENERATED_FILES // 20)
@settings(max_examples=GENERATED_FILES, database=None)
@given(documents)
def test_any_file_is_either_a_course_or_refused_with_a_line(document: str | bytes) -> None:
    content = document if isinstance(document, bytes) else document.encode(errors='replace')
    start_sec = time.thread_time()
    try:
        with TemporaryDirectory() as folder:
            file = Path(folder) / 'course.yaml'
            file.write_bytes(content)
            found: Course | tuple[Problem, ...] = load_course(file)
    except FileRefused as refused:
        found = refused.problems
        lines = str(refused).split('\n')
        assert all(line.startswith(f'{file}: line ') for line in lines), lines
    if isinstance(found, tuple):
        assert found
        assert all(problem.line >= 1 and problem.column >= 1 for problem in found)
    else:
        legs = plan_route(found).legs
        assert legs[-1].last == len(found.stops) - 1
        assert all(map(math.isfinite, plan_speeds(legs[0].curve, legs[0].speeds_m_s)))
    # Of the processor's time: hypothesis' own deadline is of a clock that a busy machine holds up.
    assert time.thread_time() - start_sec < 2.0
