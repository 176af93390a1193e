# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read a waypoint file into a checked, frozen course; every mistake is named at once."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from itertools import pairwise
import math
from pathlib import Path
import re

from husky_course.waypoints.course import (
    Course,
    COURSE_FIELDS,
    Field,
    REQUIRED_OF_A_WAYPOINT,
    Waypoint,
    WAYPOINT_FIELDS,
)
from husky_course.waypoints.yaml_tree import FileRefused, parse_yaml, Problem, read_yaml, Value

MAX_LENGTH_M = 2000.0
MIN_SPACING_M = 0.05

_NUMBER = re.compile(r'[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?', re.ASCII)


def load_course(path: str | Path) -> Course:
    """
    Return the course in a waypoint file.

    :raises FileRefused: with every mistake, each with its line, column and field.
    """
    path = Path(path)
    return _Checker(str(path)).course(read_yaml(path), path.stem)


def parse_course(text: str, name: str = 'waypoints.yaml') -> Course:
    """Return the course in the text of a waypoint file; see `load_course`."""
    return _Checker(name).course(parse_yaml(text, name), Path(name).stem)


class _Checker:
    """Collects what is wrong while it reads, so that one run shows all of it."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._problems: list[Problem] = []

    def course(self, root: Value, name: str) -> Course:
        given: dict[str, object] = {}
        if root.kind != 'mapping':
            example = "begin with 'waypoints:' and one '- [x, y]' a line"
            self._wrong(root, '', f'{root} instead of a waypoint file; {example}')
        else:
            given = self._fields(root, '', COURSE_FIELDS)
            if 'waypoints' not in {key.text for key, _ in root.pairs}:
                self._wrong(root, 'waypoints', "missing; add 'waypoints:' and '- [x, y]' lines")
        waypoints = given.get('waypoints')
        if isinstance(waypoints, tuple):
            self._check_spacing(waypoints, bool(given.get('loop')))
            if not given.get('loop'):
                self._check_first(waypoints[0])
        if self._problems:
            raise FileRefused(self._file, self._problems)
        return Course(name=name, file=self._file, **given)  # type: ignore[arg-type]

    def _wrong(self, where: Value | Waypoint, field_name: str, message: str) -> None:
        column = where.column if isinstance(where, Value) else 1
        self._problems.append(Problem(where.line, column, field_name, message))

    def _fields(
        self, mapping: Value, prefix: str, allowed: Mapping[str, Field]
    ) -> dict[str, object]:
        """Return the values of a mapping by attribute name; wrong ones are left out."""
        seen: dict[str, int] = {}
        result: dict[str, object] = {}
        for key, value in mapping.pairs:
            if key.kind != 'scalar' or key.text not in allowed:
                self._wrong(key, prefix.rstrip('.'), f'{key} is no field; {_choice(key, allowed)}')
                continue
            name = prefix + key.text
            if key.text in seen:
                self._wrong(key, name, f'given again; it is already in line {seen[key.text]}')
                continue
            seen[key.text] = key.line
            field = allowed[key.text]
            checked = self._field(field, value, name)
            if checked is not None:
                result[field.attribute] = checked
        return result

    def _field(self, field: Field, value: Value, name: str) -> object:
        if 'enum' in field.schema:
            return self._word(field, value, name)
        read = {'number': self._number, 'boolean': self._truth, 'array': self._waypoints}
        return read[field.schema['type']](field, value, name)

    def _number(self, field: Field, value: Value, name: str) -> float | None:
        low, high = field.schema['minimum'], field.schema['maximum']
        allowed = f'allowed is {low:g} to {high:g} {field.unit}'
        if value.kind != 'scalar' or value.quoted or not _NUMBER.fullmatch(value.text):
            why = ' (a number without quotes)' if value.quoted else _number_hint(value)
            self._wrong(value, name, f'{value} is not a number{why}; {allowed}')
            return None
        number = float(value.text)
        if not low <= number <= high:
            self._wrong(
                value, name, f'{value} is out of range; {allowed}{_range_hint(field, value)}'
            )
            return None
        return number

    def _truth(self, _: Field, value: Value, name: str) -> bool | None:
        if value.kind == 'scalar' and not value.quoted and value.text in ('true', 'false'):
            return value.text == 'true'
        near = {'yes': 'true', 'on': 'true', '1': 'true', 'no': 'false', 'off': 'false'}
        near |= {'0': 'false', 'true': 'true', 'false': 'false'}
        meant = near.get(value.text.lower()) if value.kind == 'scalar' else None
        hint = f'; did you mean {meant}?' if meant else ''
        self._wrong(value, name, f'{value} is not allowed; write true or false{hint}')
        return None

    def _word(self, field: Field, value: Value, name: str) -> str | None:
        words = field.schema['enum']
        if value.kind == 'scalar' and value.text in words:
            return value.text
        self._wrong(value, name, f'{value} is not allowed; {_choice(value, words)}')
        return None

    def _waypoints(self, field: Field, value: Value, name: str) -> tuple[Waypoint, ...] | None:
        if value.kind != 'list':
            self._wrong(value, name, f"{value} instead of a list; write one '- [x, y]' a line")
            return None
        least, most = field.schema['minItems'], field.schema['maxItems']
        if not least <= len(value.items) <= most:
            count = len(value.items)
            self._wrong(value, name, f'{count} given; allowed are {least} to {most}')
            return None
        read = [self._waypoint(item, f'{name}[{i}]') for i, item in enumerate(value.items)]
        complete = tuple(point for point in read if point is not None)
        return complete if len(complete) == len(read) else None

    def _waypoint(self, value: Value, name: str) -> Waypoint | None:
        if value.kind == 'list':
            return self._pair(value, name)
        if value.kind != 'mapping':
            self._wrong(value, name, f'{value} is no waypoint; write [x, y] or {{x: .., y: ..}}')
            return None
        before = len(self._problems)
        given = self._fields(value, name + '.', WAYPOINT_FIELDS)
        keys = {key.text for key, _ in value.pairs}
        for axis in REQUIRED_OF_A_WAYPOINT:
            if axis not in keys:
                self._wrong(value, f'{name}.{axis}', 'missing; every waypoint needs x and y')
        if len(self._problems) > before:
            return None
        return Waypoint(line=value.line, **given)  # type: ignore[arg-type]

    def _pair(self, value: Value, name: str) -> Waypoint | None:
        if len(value.items) != 2:
            count = len(value.items)
            comma = ', with a decimal point and not a comma' if count in (3, 4) else ''
            self._wrong(value, name, f'{count} values instead of 2; write [x, y]{comma}')
            return None
        given = {}
        for axis, item in zip(REQUIRED_OF_A_WAYPOINT, value.items, strict=True):
            field = WAYPOINT_FIELDS[axis]
            given[field.attribute] = self._field(field, item, f'{name}.{axis}')
        return None if None in given.values() else Waypoint(line=value.line, **given)  # type: ignore[arg-type]

    def _check_first(self, first: Waypoint) -> None:
        """Refuse yaw and dwell where the drive begins; of a loop, it also ends there."""
        asked = {'yaw': first.yaw_rad is not None, 'dwell': first.dwell_sec > 0.0}
        for name in (name for name, given in asked.items() if given):
            message = 'not for the first waypoint, where the drive begins; leave it out'
            self._wrong(first, f'waypoints[0].{name}', message)

    def _check_spacing(self, points: tuple[Waypoint, ...], loop: bool) -> None:
        if loop and len(points) < 3:
            self._wrong(points[0], 'waypoints', '2 given; a loop needs at least 3')
        length = 0.0
        for i, j in pairwise([*range(len(points)), *([0] if loop else [])]):
            a, b = points[i], points[j]
            distance = math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)
            length += distance
            if distance < MIN_SPACING_M:
                late, early = (j, i) if j else (i, j)
                hint = '; leave it out, a loop comes back by itself' if j == 0 else ''
                message = f'{distance:.3f} m from waypoints[{early}]; at least {MIN_SPACING_M} m'
                self._wrong(points[late], f'waypoints[{late}]', message + hint)
        if length > MAX_LENGTH_M:
            message = f'{length:.0f} m from first to last; allowed is up to {MAX_LENGTH_M:g} m'
            self._wrong(points[0], 'waypoints', message)


def _choice(value: Value, allowed: Iterable[str]) -> str:
    text = value.text if value.kind == 'scalar' else ''
    near = get_close_matches(text.lower()[:40], list(allowed), n=1, cutoff=0.5)
    names = ', '.join(allowed)
    return (f'did you mean {near[0]}? ' if near else '') + f'allowed: {names}'


def _number_hint(value: Value) -> str:
    text = value.text if value.kind == 'scalar' else ''
    if re.fullmatch(r'[-+]?\d+,\d+', text, re.ASCII):
        return f' (write {text.replace(",", ".")})'
    unit = re.fullmatch(r'([-+]?\d*\.?\d+)\s*[a-zA-Z/%°]+\d?', text, re.ASCII)
    return f' (write {unit[1]}, without the unit)' if unit else ''


def _range_hint(field: Field, value: Value) -> str:
    if field.attribute == 'speed_m_s' and value.text.startswith('-'):
        return '; to drive backwards write reverse: true'
    if field.attribute == 'yaw_rad' and 2 * math.pi < abs(float(value.text)) <= 720:
        radians = math.remainder(math.radians(float(value.text)), 2 * math.pi)
        return f'; {value.text} degrees would be {radians:.4f}'
    return ''
