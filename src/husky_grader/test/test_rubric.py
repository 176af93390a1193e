# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Rubrics: what they may say, and how each mistake is told."""

from itertools import pairwise
import json
from pathlib import Path
from typing import Any

from husky_course.checked_yaml import FileRefused
from husky_grader.grade import main as grade
from husky_grader.rubric.forms import Form
from husky_grader.rubric.impossible import impossible_courses
from husky_grader.rubric.rubric_file import load_rubric, parse_rubric
from husky_grader.rubric.schema import schema_text
from husky_grader.rubric.steps import DriveStep, PublisherStep
import jsonschema
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[3]
CONFIG = ROOT / 'config'
RUBRICS = [
    *sorted((CONFIG / 'rubrics').glob('*.yaml')),
    *(ROOT / 'docs' / 'rubrics').glob('*.yaml'),
]
PROGRAM = 'points: 1, package: p, executable: e'
TOPIC = f'{PROGRAM}, topic: t'
STRING = 'type: std_msgs/msg/String'
LAUNCH = f'points: 1, package: p, topic: t, {STRING}'


def problems(*steps: str, file: str = 'rubric.yaml') -> list[str]:
    lines = ''.join(f'  - {{{step}}}\n' for step in ('kind: build, points: 1', *steps))
    with pytest.raises(FileRefused) as refused:
        parse_rubric(f'title: T\nsteps:\n{lines}', file)
    return str(refused.value).splitlines()


def test_every_rubric_of_the_lab_is_valid() -> None:
    assert [load_rubric(path).points for path in RUBRICS] == [100.0] * 4


def test_a_rubric_says_what_stands_in_the_file() -> None:
    file = CONFIG / 'rubrics' / 'ros_packages_and_topics.yaml'
    sheet = load_rubric(file)
    publisher, drive = sheet.steps[4], sheet.steps[6]
    assert isinstance(publisher, PublisherStep)
    assert (publisher.name, publisher.topic, publisher.rate_hz) == ('publisher', '/topic_test', 10)
    assert publisher.content[0].form == Form('hello world <number>')
    assert publisher.costs.rate == 30.0
    assert isinstance(drive, DriveStep)
    assert drive.courses[0].file.samefile(CONFIG / 'waypoints' / 'central_barrier.yaml')
    assert sheet.courses.count(drive.courses[0].file) == 1
    assert sheet.files == (file, *sheet.courses)
    assert all(path.is_file() for path in sheet.files)


def test_what_a_rubric_leaves_out_is_made_of_what_it_says() -> None:
    course = CONFIG / 'waypoints' / 'straight.yaml'
    topic = f'kind: publisher, after_drive: {course}, points: 0.5, package: p, topic: /t'
    topic += f', launch: p.launch.py, {STRING}'
    package = 'points: 0.5, kind: package, package_with: setup.py'
    build = 'points: 0, kind: build'
    rubric = parse_rubric(f'title: T\nsteps: [{{{package}}}, {{{build}}}, {{{topic}}}]')
    assert rubric.points == 1.0
    assert [step.name for step in rubric.steps] == ['package with setup.py', 'build', 'publisher']
    assert isinstance(rubric.steps[2], PublisherStep)
    assert rubric.steps[2].topic == '/t'
    assert rubric.courses == (course,)


def test_steps_may_be_named_in_any_script(tmp_path: Path) -> None:
    steps = ''.join(f'  - {{kind: path, points: 1, name: {name}}}\n' for name in ('先', '后'))
    rubric = parse_rubric(f'title: T\nsteps:\n{steps}', str(tmp_path / 'rubric.yaml'))
    assert len({step.file_name for step in rubric.steps}) == 2


def test_no_step_takes_the_files_of_another() -> None:
    course = f'{{file: {CONFIG / "waypoints" / "straight.yaml"}}}'
    two = f"kind: drive, {PROGRAM}, arguments: ['{{course}}'], courses: [{course}, {course}]"

    def other(number: int | str) -> str:
        return f'kind: drive, {PROGRAM}, name: drive {number}, courses: [{course}]'

    for number in (1, 2):
        told = [line.partition(': steps')[2] for line in problems(two, other(number))]
        more = 'is the name of another step, too, or of its files; give each its own'
        assert told == [f'[1].name: drive {more}', f'[2].name: drive {number} {more}']
    steps = (two, *(other(number) for number in (0, 3, 30, '30 1')))
    text = ''.join(f'  - {{{step}}}\n' for step in ('kind: build, points: 1', *steps))
    assert len(parse_rubric(f'title: T\nsteps:\n{text}').steps) == 6


def test_every_mistake_of_a_rubric_is_told_with_its_place() -> None:
    assert problems(
        'kind: publsher, points: 1',
        f'kind: publisher, {TOPIC}, type: std_msgs/msg/Sring, rate: 10',
        'kind: workspace, points: many, forms: [<numbr>]',
        'kind: package, name: package p',
    ) == [
        'rubric.yaml: line 4, column 12: steps[1].kind: publsher is not allowed; did you mean '
        'publisher? allowed: workspace, package, build, publisher, subscriber, service, '
        'drive, path',
        'rubric.yaml: line 5, column 77: steps[2].type: std_msgs/msg/Sring is no type of '
        'messages that is installed here; did you mean std_msgs/msg/String?',
        'rubric.yaml: line 5, column 97: steps[2]: rate is no field; did you mean rate_hz? '
        'allowed: kind, name, points, needs, needs_one_of, package, package_with, executable, '
        'launch, arguments, parameters, topic, type, rate_hz, rate_tolerance, content, '
        'after_drive, call, within_sec, listen_sec, costs',
        'rubric.yaml: line 6, column 31: steps[3].points: many is not a number; '
        'allowed is 0 to 1000 points',
        'rubric.yaml: line 6, column 45: steps[3].forms[0]: <numbr> is no placeholder; did you '
        'mean <number>? allowed: <number>, <digits>, <word>, <text>',
        'rubric.yaml: line 7, column 5: steps[4].points: missing; every package step needs kind '
        'and points',
    ]


@pytest.mark.parametrize(
    ('step', 'expected'),
    [
        (
            f'kind: publisher, {TOPIC}, {STRING}, costs: {{rat: 5}}',
            'rat is no field; did you mean',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, costs: {{rate: 105}}',
            'allowed is 0 to 100 percent',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, content: [{{field: dat, equals: a}}]',
            'steps[1].content: dat of dat is no field; did you mean data? allowed: data',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, content: [{{field: zzz, equals: a}}]',
            'steps[1].content: zzz of zzz is no field; allowed: data',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, content: [{{field: data.x, equals: a}}]',
            'steps[1].content: x of data.x is no field; nothing is below it',
        ),
        (
            f'kind: publisher, {TOPIC}, type: q/w',
            'steps[1].type: q/w is no type of messages that is installed here; write it as '
            'std_msgs/msg/String, or install its package',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, content: [{{field: data}}]',
            'data: say what it must hold: form, equals, least or most',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, call: {{service: s, type: std_srvs/srv/Trig}}',
            'steps[1].call.type: std_srvs/srv/Trig is no type of services that is installed',
        ),
        (
            f'kind: publisher, {TOPIC}, type: std_msgs/String',
            'std_msgs/String is no type of messages that is installed here; did you mean std_msg',
        ),
        (
            f'kind: publisher, {TOPIC}, type: std_srvs/srv/Trigger',
            'std_srvs/srv/Trigger is no type of messages that is installed here',
        ),
        (
            f'kind: publisher, {TOPIC}, type: nowhere_msgs/msg/A',
            'nowhere_msgs/msg/A is no type of messages that is installed here',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, '
            'call: {service: s, type: std_srvs/srv/SetBool, request: {data: maybe}}',
            "steps[1].call: data: 'maybe' is refused",
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, content: [{{field: data, equals: [a]}}]',
            'data equals a text, a number, true or false, and nothing else',
        ),
        (
            f'kind: subscriber, {TOPIC}, {STRING}, sent: {{data: a}}, printed: a',
            'steps[1].printed: lacks {token}, the number that tells that it was heard',
        ),
        (
            f"kind: subscriber, {TOPIC}, {STRING}, sent: {{data: a}}, printed: '{{token}}'",
            'steps[1].sent: lacks {token}, the number that tells that it was heard',
        ),
        (
            f"kind: subscriber, {TOPIC}, {STRING}, sent: {{data: '{{token}}'}}, "
            "printed: '{token} <numbr>'",
            'steps[1].printed: <numbr> is no placeholder; did you mean <number>?',
        ),
        (
            f'kind: service, {PROGRAM}, service: s, type: std_srvs/srv/SetBool, '
            'request: {data: maybe}',
            "steps[1].request: data: 'maybe' is refused",
        ),
        (
            f"kind: subscriber, {TOPIC}, type: std_msgs/msg/Bool, sent: {{data: '{{token}}'}}, "
            "printed: '{token}'",
            "steps[1].sent: data: '{token}' is refused",
        ),
        ('kind: package, points: 1', 'steps[1].package: give package or package_with'),
        ('kind: package, points: 1, package: a b', 'a b is no name; allowed are letters, digits'),
        ('points: 1', 'line 4, column 5: steps[1]: a mapping of 1 without a kind; allowed: '),
        (
            f'kind: publisher, {TOPIC}, {STRING}, rate_hz: 200 ms',
            '200 ms is not a number (write it in Hz, without the unit); allowed is',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, launch: a.launch.py',
            'give executable or launch, ',
        ),
        (
            f'kind: publisher, {LAUNCH}, launch: patrol',
            'patrol is no launch file, as patrol.launch.py, .xml or .yaml',
        ),
        (
            f'kind: publisher, {LAUNCH}, launch: a.launch.py, parameters: {{a: 1}}',
            'steps[1].parameters: they are for an executable; write arguments: [NAME:=VALUE]',
        ),
        (
            f"kind: publisher, {LAUNCH}, launch: a.launch.py, arguments: ['a=1']",
            'steps[1].arguments: a=1: a launch file takes arguments as NAME:=VALUE',
        ),
        ('kind: workspace, points: 25/3', '25/3 is not a number; allowed is 0 to 1000 points'),
        (
            f'kind: publisher, {TOPIC}, type: std_msgs/msg/Int8, '
            'content: [{field: data, least: 9, most: 3}]',
            'steps[1].content: data: least 9 is above most 3',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, parameters: {{a: [1, 2.0]}}',
            'steps[1].parameters: a is a number, a text, true or false, or a list of one kind',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, parameters: {{a: {{b: 1}}}}',
            'steps[1].parameters: a is a number, a text, true or false, or a list of one kind',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, parameters: {{my rate: 1}}',
            'steps[1].parameters: my rate is no name of a parameter; write it as rate_hz',
        ),
        (
            f'kind: publisher, {TOPIC}, {STRING}, arguments: [{{course}}]',
            "steps[1].arguments[0]: a mapping of 1 instead of a text; write '{course}' in quotes",
        ),
        (
            f"kind: drive, {PROGRAM}, courses: [{{file: 'courses\\no.yaml'}}]",
            'no.yaml: no such file; write / between folders',
        ),
        (f'kind: publisher, {PROGRAM}, topic: 7up, {STRING}', '7up is no topic or service'),
        (
            f'kind: drive, {PROGRAM}, courses: [{{file: nowhere.yaml}}]',
            'nowhere.yaml: no such file',
        ),
        (
            f'kind: drive, {PROGRAM}, courses: [{{file: [a]}}]',
            'steps[1].courses[0].file: a list of 1 instead of a text',
        ),
        (
            f"kind: drive, {PROGRAM}, arguments: ['{{course}}'], "
            f'courses: [{{file: {CONFIG}/waypoints/straight.yaml, hidden: true}}]',
            'a hidden course needs a title, which is all that students are told',
        ),
        ('kind: build, points: 1', 'steps[1].name: build is the name of another step, too'),
        (
            'kind: workspace, points: 1, needs: [publisher]',
            'line 4, column 41: steps[1].needs: publisher is no step; allowed: build, workspace',
        ),
        ('kind: workspace, points: 1, needs: [biuld]', 'biuld is no step; did you mean build?'),
        ('kind: workspace, points: 1, needs: [workspace]', 'neither could ever count'),
    ],
)
def test_a_mistake_in_a_step_is_told_with_what_is_allowed(step: str, expected: str) -> None:
    assert any(expected in line for line in problems(step)), problems(step)


@pytest.mark.parametrize(
    ('kind', 'check', 'expected'),
    [
        ('std_msgs/msg/String', 'data, least: 3', 'type string; least and most are for numbers'),
        ('std_msgs/msg/Bool', 'data, most: 1', 'type boolean; least and most are for numbers'),
        ('std_msgs/msg/String', 'data, equals: 5', 'type string; equals must be a text in quotes'),
        ('std_msgs/msg/Bool', 'data, equals: 1', 'type boolean; equals must be true or false'),
        ('std_msgs/msg/Int32', 'data, equals: true', 'type int32; equals must be a number'),
        ('std_msgs/msg/Int32', 'data, equals: 0.5', 'type int32; equals must be a whole number'),
        ('std_msgs/msg/UInt8', 'data, equals: 256', 'type uint8; equals must be from 0 to 255'),
        ('std_msgs/msg/Int8', 'data, equals: -129', 'type int8; equals must be from -128 to 127'),
        ('std_msgs/msg/UInt8', 'data, least: 255.5', 'type uint8; least must be 255 or less'),
        ('std_msgs/msg/UInt64', 'data, most: -1', 'type uint64; most must be 0 or more'),
        ('std_msgs/msg/Float64', "data, equals: '5'", 'type double; equals must be a number'),
        (
            'sensor_msgs/msg/JointState',
            'name, equals: 5',
            'type sequence<string>; equals must be a text in quotes',
        ),
        (
            'sensor_msgs/msg/CameraInfo',
            'k, equals: no',
            'type double[9]; equals must be a number',
        ),
        (
            'diagnostic_msgs/msg/DiagnosticStatus',
            'level, equals: 0',
            'type octet; equals must be left out',
        ),
        (
            'geometry_msgs/msg/PoseArray',
            'poses, least: 1',
            'type sequence<geometry_msgs/Pose>; least and most are for numbers',
        ),
    ],
)
def test_a_check_that_no_value_of_its_field_fits_is_told(
    kind: str, check: str, expected: str
) -> None:
    (told,) = problems(f'kind: publisher, {TOPIC}, type: {kind}, content: [{{field: {check}}}]')
    name = check.partition(',')[0]
    assert told.endswith(f'steps[1].content: {name} is of {expected}')


@pytest.mark.parametrize('asked', ['least: 3', 'equals: 5', 'form: <text>'])
def test_a_message_is_no_field_that_can_be_checked(asked: str) -> None:
    service = 'service: s, type: std_srvs/srv/Trigger, response: [{field: message, most: 1}]'
    content = f'type: std_msgs/msg/Header, content: [{{field: stamp, {asked}}}]'
    message, text = problems(
        f'kind: publisher, {TOPIC}, {content}', f'kind: service, {PROGRAM}, {service}'
    )
    assert message.endswith('.content: stamp is a message; name one of its fields: sec, nanosec')
    assert text.endswith('.response: message is of type string; least and most are for numbers')


@pytest.mark.parametrize(
    ('kind', 'check'),
    [
        ('std_msgs/msg/Float32', 'data, equals: 5'),
        ('std_msgs/msg/Int32', 'data, equals: 5.0, least: 1'),
        ('std_msgs/msg/UInt8', 'data, equals: 255, least: -1, most: 1000'),
        ('std_msgs/msg/Bool', "data, equals: true, form: 'True'"),
        ('std_msgs/msg/String', "data, equals: '5'"),
        ('sensor_msgs/msg/LaserScan', 'ranges, least: 0.1, most: 30'),
        ('sensor_msgs/msg/CameraInfo', 'k, equals: 0'),
        ('sensor_msgs/msg/JointState', 'name, equals: wheel'),
        ('diagnostic_msgs/msg/DiagnosticStatus', 'level, form: <text>'),
        ('std_msgs/msg/UInt8', 'data, least: 255, most: 255'),
        ('std_msgs/msg/Int8', 'data, least: -128, most: -128'),
        ('geometry_msgs/msg/PoseArray', 'poses, form: <text>'),
    ],
)
def test_a_check_that_a_value_of_its_field_can_fit_is_taken(kind: str, check: str) -> None:
    step = f'kind: publisher, {TOPIC}, type: {kind}, content: [{{field: {check}}}]'
    build = 'kind: build, points: 1'
    rubric = parse_rubric(f'title: T\nsteps: [{{{build}}}, {{{step}}}]')
    assert isinstance(rubric.steps[1], PublisherStep)
    assert len(rubric.steps[1].content) == 1


JUNK = ['', '~', '[]', '{}', '-1', 'x', '[x, {y: z}]', '{kind: build}', "''", '.nan', '&a 1', '{{']


def test_any_change_of_a_rubric_is_read_or_refused_with_a_line() -> None:
    lines = RUBRICS[0].read_text().splitlines()
    for number, line in enumerate(lines):
        junk = f'{line.partition(":")[0]}: {JUNK[number % len(JUNK)]}'
        for changed in ([], [junk], [line, line]):
            text = '\n'.join([*lines[:number], *changed, *lines[number + 1 :]])
            try:
                parse_rubric(text, str(RUBRICS[0]))
            except FileRefused as refused:
                assert all(problem.line >= 1 for problem in refused.problems), text


def test_a_launch_file_may_end_as_those_of_ros_1_do() -> None:
    # `ros2 launch` tries each of its parsers where an ending tells none.
    step = f'kind: publisher, {LAUNCH}, launch: patrol.launch'
    assert parse_rubric(f'title: T\nsteps:\n  - {{kind: build, points: 1}}\n  - {{{step}}}\n')


@pytest.mark.parametrize('hidden', ['hidden: true, title: A', 'title: A}, {file: square.yaml'])
def test_a_program_must_be_told_which_course_it_is(hidden: str) -> None:
    step = f'kind: drive, {PROGRAM}, courses: [{{file: straight.yaml, {hidden}}}]'
    file = str(CONFIG / 'waypoints' / 'rubric.yaml')
    assert 'put {course} into arguments' in problems(step, file=file)[0]


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('steps: [{kind: build, points: 0}]', 'line 2, column 8: steps: no step gives points; '),
        (
            'world: no.xml\nsteps: [{kind: build, points: 1}]',
            r"line 2, column 8: world: '.*no\.xml': no such file; give the path of an MJCF file",
        ),
        (
            'world: worlds\\no.xml\nsteps: [{kind: build, points: 1}]',
            r'line 2, column 8: world: .*no\.xml: no such file; write / between folders',
        ),
        (
            'world: [a]\nsteps: [{kind: build, points: 1}]',
            'line 2, column 8: world: a list of 1 instead of a text',
        ),
        (
            'interfaces: [nowhere]\nsteps: [{kind: build, points: 1}]',
            'line 2, column 13: interfaces: .*/nowhere has no package.xml; name the folder of a',
        ),
        (
            'interfaces: [[nowhere]]\nsteps: [{kind: build, points: 1}]',
            r'line 2, column 14: interfaces\[0\]: a list of 1 instead of a text',
        ),
        (
            'steps:\n  kind: build\n  - kind: build',
            "line 3, column 3: a dash is missing; write '-",
        ),
        ('title: Lab 8: T', 'line 2, column 13: a text with a colon in it; put all that stands '),
    ],
)
def test_a_mistake_that_concerns_all_steps_is_told(text: str, told: str) -> None:
    with pytest.raises(FileRefused, match=told) as refused:
        parse_rubric(f'title: T\n{text}')
    assert len(str(refused.value).splitlines()) == 1


def test_a_circle_of_needs_is_told_however_long() -> None:
    names = 'abcda'
    told = problems(
        *(
            f'points: 1, kind: workspace, name: {name}, needs: [{needed}]'
            for name, needed in pairwise(names)
        )
    )
    assert [line.partition('.needs: ')[2].partition(':')[0] for line in told] == [
        f'{needed} needs {name} itself' for name, needed in pairwise(names)
    ]


def test_a_list_is_no_rubric_and_names_no_interfaces() -> None:
    with pytest.raises(FileRefused) as refused:
        parse_rubric('- a\n')
    (line,) = str(refused.value).splitlines()
    assert line.endswith('a list of 1 instead of a rubric; write a mapping: title, steps')


def test_a_course_through_an_obstacle_is_told_before_anything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rubric = tmp_path / 'rubric.yaml'
    (tmp_path / 'short.yaml').write_text('waypoints: [[0, 0], [4, 0]]\n')
    drive = f'kind: drive, {PROGRAM}, courses: [{{file: short.yaml}}]'
    rubric.write_text(f'title: T\nsteps: [{{kind: build, points: 1}}, {{{drive}}}]\n')
    command = ['--lab', str(tmp_path / 'none'), '--rubric', str(rubric)]
    assert grade([*command, '--report', str(tmp_path / 'report')]) == 2
    told, _ = capsys.readouterr().err.splitlines()
    start = (
        f'{rubric}: the course short.yaml goes through jersey_barrier_15 in the playpen, so that'
    )
    assert told.startswith(start)
    rubric.write_text(f'world: {ROOT}/worlds/empty.xml\n{rubric.read_text()}')
    assert list(impossible_courses(load_rubric(rubric))) == []


def test_a_program_cannot_run_before_the_build() -> None:
    with pytest.raises(FileRefused, match='put a step of kind build before it'):
        parse_rubric(f'title: T\nsteps: [{{kind: publisher, {TOPIC}, {STRING}}}]')


@pytest.fixture
def schema() -> Any:
    text = (CONFIG / 'rubric.schema.json').read_text()
    return jsonschema.Draft202012Validator(json.loads(text))


def test_the_schema_of_rubrics_is_made_from_the_tables() -> None:
    command = './lab exec python3 -m husky_grader.rubric.schema > config/rubric.schema.json'
    assert (CONFIG / 'rubric.schema.json').read_text() == schema_text(), f'run: {command}'


@pytest.mark.parametrize('path', RUBRICS, ids=lambda path: path.stem)
def test_the_schema_accepts_every_rubric(schema: Any, path: Path) -> None:
    jsonschema.Draft202012Validator.check_schema(schema.schema)
    assert list(schema.iter_errors(yaml.safe_load(path.read_text()))) == []


@pytest.mark.parametrize(
    'step',
    [
        'kind: publsher, points: 1',
        f'kind: publisher, {TOPIC}, {STRING}, rate: 10',
        f'kind: publisher, {TOPIC}, {STRING}, rate_hz: fast',
        'kind: build',
        'kind: workspace, points: 1, forms: a',
    ],
)
def test_the_schema_refuses_what_the_grader_refuses(schema: Any, step: str) -> None:
    assert problems(step)
    assert list(schema.iter_errors(yaml.safe_load(f'title: T\nsteps: [{{{step}}}]')))
