# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The tables of the fields that a rubric may hold."""

from collections.abc import Mapping
from dataclasses import fields
import re
from typing import Any

from husky_course.checked_yaml import Field, number, Table

from husky_grader.rubric.forms import Form, TOKEN
from husky_grader.rubric.interfaces import message_type, service_type
from husky_grader.rubric.steps import (
    BuildStep,
    COURSE,
    CourseToDrive,
    DriveCosts,
    DriveLimits,
    DriveStep,
    FieldCheck,
    PackageCosts,
    PackageStep,
    PathCosts,
    PathStep,
    Place,
    PublisherCosts,
    PublisherStep,
    Rubric,
    ServiceCall,
    ServiceCosts,
    ServiceStep,
    Step,
    SubscriberCosts,
    SubscriberStep,
    WorkspaceCosts,
    WorkspaceStep,
)

_TEXT = {'type': 'string'}
_TRUTH = {'type': 'boolean'}
_MAPPING = {'type': 'object'}
_PLACEHOLDERS = '<number>, <digits>, <word>, and <text> for anything'
_NAME = re.compile(r'[A-Za-z][\w.-]*', re.ASCII)
_TOPIC = re.compile(r'/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*', re.ASCII)


def _texts(least: int = 0) -> Mapping[str, Any]:
    return {'type': 'array', 'items': _TEXT, 'minItems': least, 'maxItems': 100}


def _list(least: int = 1) -> Mapping[str, Any]:
    return {'type': 'array', 'minItems': least, 'maxItems': 100}


def _name(text: str) -> str:
    if not _NAME.fullmatch(text):
        raise ValueError(f'{text} is no name; allowed are letters, digits, _, - and .')
    return text


def _topic(text: str) -> str:
    if not _TOPIC.fullmatch(text):
        raise ValueError(f'{text} is no topic or service; write a name as front/scan')
    return text if text.startswith('/') else f'/{text}'


def _costs(made: type[Any], **words: str) -> Field:
    """Return the field of what each defect costs, in percent of the step's points."""
    names = {entry.name: entry.default for entry in fields(made)}
    table = {
        name: Field(name, f'Percent that it costs: {words[name]}.', number(0, 100), 'percent')
        for name in names
    }
    return Field(
        'costs',
        'What each defect costs, in percent of the points.',
        _MAPPING,
        table=Table('list of costs', made, table),
    )


_STEP = {
    'kind': Field('kind', 'What kind of step it is.', _TEXT),
    'name': Field('name', 'What it is called; the kind where it is left out.', _TEXT),
    'points': Field('points', 'The points for it.', number(0, 1000), 'points'),
    'needs': Field('needs', 'Steps that must all have points, or it gets none.', _texts(1)),
    'needs_one_of': Field(
        'needs_one_of', 'Steps of which one must have points, or it gets none.', _texts(1)
    ),
}
_WHOSE = {
    'package': Field('package', 'The name of the package.', _TEXT, parse=_name),
    'package_with': Field(
        'package_with',
        'In the place of package: a file that it has, where its name is free.',
        _TEXT,
    ),
}
_PROGRAM = {
    **_STEP,
    **_WHOSE,
    'executable': Field('executable', 'As after `ros2 run PACKAGE`.', _TEXT, parse=_name),
    'launch': Field(
        'launch',
        'In the place of executable: a launch file, as after `ros2 launch PACKAGE`.',
        _TEXT,
        parse=_name,
    ),
    'arguments': Field(
        'arguments',
        f'Its arguments; {COURSE}: the waypoint file. Of a launch file as NAME:=VALUE.',
        _texts(),
    ),
    'parameters': Field('parameters', 'Parameters of its nodes by name.', _MAPPING),
}
_WITHIN = Field(
    'within_sec',
    's of the clock: so long is waited for it; longer on a busy machine.',
    number(1, 300),
    's',
)
_TOPIC_OF = {
    'topic': Field('topic', 'The name of the topic.', _TEXT, parse=_topic),
    'type': Field(
        'type', 'The type of its messages, as std_msgs/msg/String.', _TEXT, parse=message_type
    ),
}
_SERVICE_OF = {
    'service': Field('service', 'The name of the service.', _TEXT, parse=_topic),
    'type': Field('type', 'Its type, as std_srvs/srv/Trigger.', _TEXT, parse=service_type),
    'request': Field('request', 'The fields of the request.', _MAPPING),
}
_FORM = Field('form', f'Its form: a text with {_PLACEHOLDERS}.', _TEXT, parse=Form)
_ANY_NUMBER = number(-1e300, 1e300)
_CHECK = Table(
    'field check',
    FieldCheck,
    {
        'field': Field('field', 'The field, as header.frame_id.', _TEXT),
        'form': _FORM,
        'equals': Field('equals', 'The very value: a text, a number, true or false.', {}),
        'least': Field('least', 'The least that the number may be.', _ANY_NUMBER),
        'most': Field('most', 'The most that the number may be.', _ANY_NUMBER),
    },
    ('field',),
)
_CALL = Table('call', ServiceCall, _SERVICE_OF, ('service', 'type'))
_COURSE = Table(
    'course',
    CourseToDrive,
    {
        'file': Field(
            'file', 'A waypoint file; its place is told from that of the rubric.', _TEXT
        ),
        'title': Field('title', 'What it is called; the name of its file if left out.', _TEXT),
        'share': Field('share', 'Its weight among the courses of the step.', number(0.01, 100)),
        'hidden': Field('hidden', 'true: students are told its title and score only.', _TRUTH),
    },
    ('file',),
)
_PLACE = Table(
    'point',
    Place,
    {
        'x': Field('x', 'm in the frame odom.', number(-1000, 1000), 'm'),
        'y': Field('y', 'm in the frame odom.', number(-1000, 1000), 'm'),
    },
    ('x', 'y'),
)
_LIMITS = Table(
    'list of limits',
    DriveLimits,
    {
        'collisions': Field('collisions', 'Collisions that are allowed.', number(0, 1000)),
        'off_path_m': Field(
            'off_path_m',
            'm off the path that are allowed, root of the mean square.',
            number(0, 100),
            'm',
        ),
        'time_sec': Field(
            'time_sec', 's of simulated time that are allowed.', number(1, 3600), 's'
        ),
    },
)


_LIMITED = {'limits': Field('limits', 'What no drive may exceed.', _MAPPING, table=_LIMITS)}
_EXCEEDED = {
    'collisions': 'more collisions than allowed',
    'off_path_m': 'further off the path than allowed',
    'time_sec': 'longer than allowed',
}


def _table(made: type[Step], more: Mapping[str, Field], *required: str) -> Table:
    return Table(f'{made.kind} step', made, more, ('kind', 'points', *required))


STEPS = {
    table.made.kind: table
    for table in (
        _table(
            WorkspaceStep,
            {
                **_STEP,
                'forms': Field(
                    'forms',
                    f'Forms that its name may have, with {_PLACEHOLDERS}; the first is told.',
                    _texts(1),
                    parse=Form,
                ),
                'costs': _costs(WorkspaceCosts, name='a name of another form'),
            },
        ),
        _table(
            PackageStep,
            {
                **_STEP,
                **_WHOSE,
                'build_type': Field('build_type', 'The build type that is asked for.', _TEXT),
                'dependencies': Field(
                    'dependencies', 'What package.xml must depend on.', _texts()
                ),
                'costs': _costs(
                    PackageCosts,
                    dependencies='a dependency lacks in package.xml',
                    build_type='another build type',
                    todo='package.xml still has a TODO of ros2 pkg create',
                ),
            },
        ),
        _table(BuildStep, _STEP),
        _table(
            PublisherStep,
            {
                **_PROGRAM,
                **_TOPIC_OF,
                'rate_hz': Field('rate_hz', 'Messages a second.', number(0.1, 1000), 'Hz'),
                'rate_tolerance': Field(
                    'rate_tolerance_percent',
                    'Percent that the rate may be off.',
                    number(1, 100),
                    'percent',
                ),
                'content': Field('content', 'What the fields must hold.', _list(), table=_CHECK),
                'after_drive': Field(
                    'after_drive',
                    'A waypoint file: a Husky is driven along it beside the program first.',
                    _TEXT,
                ),
                'call': Field(
                    'call',
                    'A service that is called before it is listened to.',
                    _MAPPING,
                    table=_CALL,
                ),
                'within_sec': _WITHIN,
                'listen_sec': Field(
                    'listen_sec',
                    's of the clock: so long is listened; at least three periods of rate_hz.',
                    number(0.5, 60),
                    's',
                ),
                'costs': _costs(
                    PublisherCosts, rate='another rate', content='a field holds something else'
                ),
            },
            *('topic', 'type'),
        ),
        _table(
            SubscriberStep,
            {
                **_PROGRAM,
                **_TOPIC_OF,
                'sent': Field(
                    'sent',
                    f'The fields of what is sent; {TOKEN}: a new number each time.',
                    _MAPPING,
                ),
                'printed': Field(
                    'printed',
                    f'What a line of its output must hold: a text with {TOKEN}, {_PLACEHOLDERS}.',
                    _TEXT,
                ),
                'within_sec': _WITHIN,
                'costs': _costs(SubscriberCosts, printed=f'the line holds {TOKEN}, but not all'),
            },
            *('topic', 'type', 'sent', 'printed'),
        ),
        _table(
            ServiceStep,
            {
                **_PROGRAM,
                **_SERVICE_OF,
                'response': Field(
                    'response', 'What the fields of the response must hold.', _list(), table=_CHECK
                ),
                'within_sec': _WITHIN,
                'costs': _costs(ServiceCosts, response='a field holds something else'),
            },
            *('service', 'type'),
        ),
        _table(
            DriveStep,
            {
                **_PROGRAM,
                'courses': Field(
                    'courses', 'What is driven.', _list(), table=_COURSE, example='- file: ...'
                ),
                'answers': Field('answers', 'What is typed into a program that asks.', _texts(1)),
                **_LIMITED,
                'costs': _costs(DriveCosts, **_EXCEEDED),
            },
            'courses',
        ),
        _table(
            PathStep,
            {
                **_STEP,
                'passes': Field(
                    'passes',
                    'Points that the path must pass, in this order.',
                    _list(),
                    table=_PLACE,
                    example='- {x: 1.0, y: 2.0}',
                ),
                'within': Field(
                    'within_m', 'm from these points that are near enough.', number(0.05, 10), 'm'
                ),
                **_LIMITED,
                'costs': _costs(
                    PathCosts, passes='the path leaves out one of the points', **_EXCEEDED
                ),
            },
        ),
    )
}
RUBRIC = Table(
    'rubric',
    Rubric,
    {
        'title': Field('title', 'What the lab is called.', _TEXT),
        'interfaces': Field(
            'interfaces',
            'Folders of packages with the types that are not installed; as seen from the rubric.',
            _texts(1),
        ),
        'world': Field(
            'world',
            'An MJCF file in the place of the playpen; its place is told from that of the rubric.',
            _TEXT,
        ),
        'steps': Field('steps', 'The steps of the lab.', _list(), example='- kind: ...'),
    },
    ('title', 'steps'),
)
