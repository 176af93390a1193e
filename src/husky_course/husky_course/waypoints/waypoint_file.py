# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read a waypoint file into a checked, frozen course; every mistake is named at once."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
import math
from pathlib import Path

from husky_course.checked_yaml import Field, FieldReader, parse_yaml, read_yaml, Value
from husky_course.waypoints.course import COURSE, Course, WAYPOINT, Waypoint

MAX_LENGTH_M = 2000.0
MIN_SPACING_M = 0.05
MAX_DWELLS_SEC = 3600.0
"""Of all together: a file must not keep a grader busy for days."""


def load_course(path: str | Path) -> Course:
    """
    Return the course in a waypoint file.

    :raises FileRefused: with every mistake, each with its line, column and field.
    """
    path = Path(path)
    return _CourseReader(str(path)).course(read_yaml(path), path.stem)


def parse_course(text: str, name: str = 'waypoints.yaml') -> Course:
    """Return the course in the text of a waypoint file; see `load_course`."""
    return _CourseReader(name).course(parse_yaml(text, name), Path(name).stem)


class _CourseReader(FieldReader):
    def course(self, root: Value, name: str) -> Course:
        given: dict[str, object] = {}
        if root.kind != 'mapping':
            example = "begin with 'waypoints:' and one '- [x, y]' a line"
            self.wrong(root, '', f'{root} instead of a waypoint file; {example}')
        else:
            given = self.fields(root, '', COURSE.fields)
            if 'waypoints' not in {key.text for key, _ in root.pairs}:
                self.wrong(root, 'waypoints', "missing; add 'waypoints:' and '- [x, y]' lines")
        waypoints = given.get('waypoints')
        if isinstance(waypoints, tuple):
            self._check_spacing(waypoints, bool(given.get('loop')))
            self._check_dwells(waypoints)
            if not given.get('loop'):
                self._check_first(waypoints[0])
        self.refuse_if_wrong()
        return Course(name=name, file=self.file, **given)  # type: ignore[arg-type]

    def item(self, _: Field, value: Value, name: str) -> Waypoint | None:
        if value.kind == 'list':
            return self._pair(value, name)
        if value.kind != 'mapping':
            self.wrong(value, name, f'{value} is no waypoint; write [x, y] or {{x: .., y: ..}}')
            return None
        point: Waypoint | None = self.mapping(WAYPOINT, value, name)
        return point and replace(point, line=value.line)

    def _pair(self, value: Value, name: str) -> Waypoint | None:
        if len(value.items) != 2:
            count = len(value.items)
            hint = {
                1: ', with a comma between them',
                3: ', without z: the ground is flat'
                if any('.' in item.text for item in value.items)
                else ', without z, and with a decimal point and not a comma',
                4: ', with a decimal point and not a comma',
            }.get(count, '')
            values = 'value' if count == 1 else 'values'
            self.wrong(value, name, f'{count} {values} instead of 2; write [x, y]{hint}')
            return None
        given = {}
        for axis, item in zip(WAYPOINT.required, value.items, strict=True):
            field = WAYPOINT.fields[axis]
            given[field.attribute] = self.value(field, item, f'{name}.{axis}')
        return None if None in given.values() else Waypoint(line=value.line, **given)  # type: ignore[arg-type]

    def field_hint(self, key: Value, allowed: Mapping[str, Field]) -> str:
        if key.text in WAYPOINT.fields and allowed is COURSE.fields:
            return f'it belongs into a waypoint: {{x: .., y: .., {key.text}: ..}}'
        return super().field_hint(key, allowed)

    def range_hint(self, field: Field, value: Value) -> str:
        if field.attribute == 'speed_m_s' and value.text.startswith('-'):
            where = ' into a waypoint' if field is COURSE.fields['speed'] else ''
            return f'; to drive backwards write reverse: true{where}'
        if field.attribute == 'yaw_rad' and 2 * math.pi < abs(float(value.text)) <= 720:
            radians = math.remainder(math.radians(float(value.text)), 2 * math.pi)
            return f'; {value.text} degrees would be {radians:.4f}'
        return ''

    def _wrong_point(self, point: Waypoint, name: str, message: str) -> None:
        self.wrong(Value(point.line, 1, 'mapping'), name, message)

    def _check_first(self, first: Waypoint) -> None:
        """Refuse yaw and dwell where the drive begins; of a loop, it also ends there."""
        asked = {'yaw': first.yaw_rad is not None, 'dwell': first.dwell_sec > 0.0}
        for name in (name for name, given in asked.items() if given):
            message = 'not for the first waypoint, where the drive begins; leave it out'
            self._wrong_point(first, f'waypoints[0].{name}', message)

    def _check_dwells(self, points: tuple[Waypoint, ...]) -> None:
        dwells_sec = sum(point.dwell_sec for point in points)
        if dwells_sec > MAX_DWELLS_SEC:
            message = f'{dwells_sec:.0f} s of dwell in all; allowed is up to {MAX_DWELLS_SEC:g} s'
            self._wrong_point(points[0], 'waypoints', message)

    def _check_spacing(self, points: tuple[Waypoint, ...], loop: bool) -> None:
        if loop and len(points) < 3:
            self._wrong_point(points[0], 'waypoints', '2 given; a loop needs at least 3')
        length = 0.0
        for i, j in pairwise([*range(len(points)), *([0] if loop else [])]):
            a, b = points[i], points[j]
            distance = math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)
            length += distance
            if distance < MIN_SPACING_M - 1e-9:  # 0.15 - 0.1 is a little less than 0.05
                late, early = (j, i) if j else (i, j)
                hint = '; leave it out, a loop comes back by itself' if j == 0 else ''
                message = f'{distance:.3f} m from waypoints[{early}]; at least {MIN_SPACING_M} m'
                self._wrong_point(points[late], f'waypoints[{late}]', message + hint)
        if length > MAX_LENGTH_M:
            message = f'{length:.0f} m from first to last; allowed is up to {MAX_LENGTH_M:g} m'
            self._wrong_point(points[0], 'waypoints', message)
