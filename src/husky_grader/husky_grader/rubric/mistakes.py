# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a step of a rubric asks for that cannot be: fields that a type lacks, and the like."""

from collections.abc import Iterator, Mapping, Sequence
import re
from typing import Any

from rosidl_runtime_py.utilities import get_message, get_service

from husky_grader.rubric.forms import Form, TOKEN, with_token
from husky_grader.rubric.interfaces import filled, type_of_field
from husky_grader.rubric.steps import (
    COURSE,
    DriveStep,
    FieldCheck,
    PackageStep,
    ProgramStep,
    PublisherStep,
    ServiceStep,
    Step,
    SubscriberStep,
)

LAUNCH_ENDINGS = ('.py', '.xml', '.yaml', '.yml', '.launch')
A_TOKEN = '12345678'
_ENTRY = re.compile(r'(sequence<)?([\w/]+).*')  # the type of what is in sequence<string<9>, 3>
_PARAMETER = re.compile(r'[A-Za-z_]\w*([./][A-Za-z_]\w*)*', re.ASCII)
_INTEGER = re.compile(r'(u?)int(\d+)')
_NUMBER = re.compile(rf'{_INTEGER.pattern}|float|double')
_A_NUMBER = (int, float), 'a number'
_A_TEXT = (str,), 'a text in quotes'
_EQUAL = {'boolean': ((bool,), 'true or false'), 'string': _A_TEXT, 'wstring': _A_TEXT}

_Mistakes = Iterator[tuple[str, str]]


def mistakes_of(step: Step) -> _Mistakes:
    """Yield the field and what is wrong with it."""
    if isinstance(step, (PackageStep, ProgramStep)) and bool(step.package) == bool(
        step.package_with
    ):
        yield 'package', 'give package or package_with, one of the two'
    if isinstance(step, ProgramStep):
        yield from _program(step)
        yield from _parameters(step.parameters)
    if isinstance(step, PublisherStep):
        yield from _checks('content', get_message(step.type)(), step.content)
        if step.call is not None:
            yield from _content('call', get_service(step.call.type).Request(), step.call.request)
    elif isinstance(step, SubscriberStep):
        yield from _subscriber(step)
    elif isinstance(step, ServiceStep):
        kind = get_service(step.type)
        yield from _content('request', kind.Request(), step.request)
        yield from _checks('response', kind.Response(), step.response)
    elif isinstance(step, DriveStep):
        yield from _drive(step)


def _program(step: ProgramStep) -> _Mistakes:
    if bool(step.executable) == bool(step.launch):
        yield 'executable', 'give executable or launch, one of the two'
    elif step.launch:
        if not step.launch.endswith(LAUNCH_ENDINGS):
            yield 'launch', f'{step.launch} is no launch file, as patrol.launch.py, .xml or .yaml'
        if step.parameters:
            yield 'parameters', 'they are for an executable; write arguments: [NAME:=VALUE]'
        for given in step.arguments:
            if ':=' not in given:
                yield 'arguments', f'{given}: a launch file takes arguments as NAME:=VALUE'


def _parameters(parameters: Mapping[str, Any]) -> _Mistakes:
    """Yield what ROS would refuse, for which a program would not even start."""
    for name, value in parameters.items():
        if not _PARAMETER.fullmatch(name):
            yield 'parameters', f'{name} is no name of a parameter; write it as rate_hz'
        entries = value if isinstance(value, list) else [value]
        kinds = {type(entry) for entry in entries}
        if len(kinds) != 1 or not kinds <= {bool, int, float, str}:
            yield (
                'parameters',
                f'{name} is a number, a text, true or false, or a list of one kind of these; '
                '1 and 2.0 are two kinds',
            )


def _subscriber(step: SubscriberStep) -> _Mistakes:
    yield from _content('sent', get_message(step.type)(), with_token(step.sent, A_TOKEN))
    lacks = f'lacks {TOKEN}, the number that tells that it was heard'
    if with_token(step.sent, A_TOKEN) == step.sent:
        yield 'sent', lacks
    if TOKEN not in step.printed:
        yield 'printed', lacks
    try:
        Form(step.printed.replace(TOKEN, A_TOKEN))
    except ValueError as error:
        yield 'printed', str(error)


def _drive(step: DriveStep) -> _Mistakes:
    told = any(COURSE in text for text in (*step.arguments, *step.answers))
    if not told and (len(step.courses) > 1 or any(course.hidden for course in step.courses)):
        yield (
            'courses',
            f'which one it is to drive is not told to the program; put {COURSE} into arguments',
        )
    for course in step.courses:
        if course.hidden and not course.title:
            yield 'courses', 'a hidden course needs a title, which is all that students are told'


def _content(field: str, message: Any, values: Mapping[str, Any]) -> _Mistakes:
    try:
        filled(message, values)
    except ValueError as error:
        yield field, str(error).replace(A_TOKEN, TOKEN)  # as it stands in the file


def _checks(field: str, message: Any, checks: Sequence[FieldCheck]) -> _Mistakes:
    for check in checks:
        try:
            kind = type_of_field(message, check.field)
        except ValueError as error:
            yield field, str(error)
        else:
            for why in _unfit(check, _ENTRY.sub(r'\2', kind)):
                yield field, f'{check.field} is of type {kind}; {why}'
        if isinstance(check.equals, (list, dict)):
            yield field, f'{check.field} equals a text, a number, true or false, and nothing else'
        if (check.form, check.equals, check.least, check.most) == (None, None, None, None):
            yield field, f'{check.field}: say what it must hold: form, equals, least or most'
        least, most = check.least, check.most
        if least is not None and most is not None and least > most:
            yield field, f'{check.field}: least {least:g} is above most {most:g}'


def _unfit(check: FieldCheck, entry: str) -> Iterator[str]:
    """
    Yield why no value of a field can be what is asked for.

    :param entry: its type; that of its entries, where it is a list.
    """
    is_number = _NUMBER.fullmatch(entry) is not None
    if not is_number and (check.least, check.most) != (None, None):
        yield 'least and most are for numbers'
    fitting, words = _A_NUMBER if is_number else _EQUAL.get(entry, ((), 'left out'))
    given = check.equals
    if isinstance(given, (bool, int, float, str)) and type(given) not in fitting:
        yield f'equals must be {words}'
    elif integer := _INTEGER.fullmatch(entry):
        lowest, highest = _range(*integer.groups())
        if isinstance(given, float) and not given.is_integer():
            yield 'equals must be a whole number'
        elif isinstance(given, (int, float)) and not lowest <= given <= highest:
            yield f'equals must be from {lowest} to {highest}'
        if check.least is not None and check.least > highest:
            yield f'least must be {highest} or less'
        if check.most is not None and check.most < lowest:
            yield f'most must be {lowest} or more'


def _range(unsigned: str, bits: str) -> tuple[int, int]:
    values = 2 ** int(bits)
    return (0, values - 1) if unsigned else (-values // 2, values // 2 - 1)
