# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What a person did where a parser of YAML gives up: a colon, a space, a column, a bracket.

The parser tells in its own words what it expected, often a line late. Here the lines around that
place are read as a person writes them: fields `key: value` and items `- ...`, one a line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
import re

import yaml

ODD_SPACES = {
    '\u00a0': 'a no-break space',
    '\u2007': 'a figure space',
    '\u202f': 'a narrow no-break space',
    '\u3000': 'an ideographic space',
    '\ufeff': 'a byte order mark',
    '\u200b': 'a zero-width space',
    '\t': 'a tab',
}
"""Characters that look like a space, or like nothing, and are none to YAML."""

_LINE_BREAK = re.compile('\r\n|[\n\r\x85\u2028\u2029]')  # YAML 1.1, 4.2: as the parser counts

_FIELD = re.compile(r'([A-Za-z_]\w*)\s*:(?:\s|$)')
_NO_SPACE = re.compile(r'([A-Za-z_]\w*):([^\s:/][^:]*)$')
_NO_COLON = re.compile(r'([A-Za-z_]\w*)(?: *= *| +)([^\s:=][^:=]*)$')
_COLON_IN_TEXT = re.compile(r'[A-Za-z_]\w*:\s.*:(\s|$)')
_NO_ITEM = re.compile(r'-[\[{]')

Found = tuple[int, int, str]
"""Line and column, from 1, and the message."""


@dataclass(frozen=True)
class Line:
    """A line with something in it; the column counts from 1, the comment is left out."""

    number: int
    column: int
    text: str

    @property
    def is_item(self) -> bool:
        return self.text == '-' or self.text.startswith('- ')

    @property
    def inner(self) -> tuple[int, str]:
        """Column and text of what stands behind the dash of an item, or of the whole line."""
        if not self.is_item:
            return self.column, self.text
        rest = self.text[1:].lstrip(' ')
        return self.column + len(self.text) - len(rest), rest

    @property
    def key(self) -> str:
        """The field that the line begins with; empty if there is none."""
        found = _FIELD.match(self.inner[1])
        return found[1] if found else ''


def explain(error: yaml.MarkedYAMLError, text: str) -> Found | None:
    """Return what was probably done where the parser gave up; None where that is not clear."""
    lines = list(_lines(text))
    problem = error.problem_mark.line + 1 if error.problem_mark else 1
    context = error.context_mark.line + 1 if error.context_mark else problem
    near = [line for line in lines if line.number in (context, problem)]
    before = [line for line in lines if line.number < problem]
    near += before[-1:]
    return (
        _merge_conflict(lines)
        or _odd_space(near, text)
        or _unclosed(error, text)
        or _first(map(_dash, [*near, *before[::-1]]))
        or _first(map(_colon, near))
        or _two_fields(error, near)
        or _column(lines, problem)
    )


def lines_of(text: str) -> list[str]:
    """Return the lines as YAML has them; texts copied from elsewhere have odd line breaks."""
    return _LINE_BREAK.split(text)


def _lines(text: str) -> Iterator[Line]:
    for number, line in enumerate(lines_of(text), 1):
        content = re.sub(r'(^|\s)#.*', '', line).strip(' ')
        if content:
            yield Line(number, len(line) - len(line.lstrip(' ')) + 1, content)


def _first(found: Iterator[Found | None]) -> Found | None:
    return next((each for each in found if each is not None), None)


def odd_space(text: str) -> tuple[int, str] | None:
    """Return the place and the name of the first character that only looks like a space."""
    for place, character in enumerate(text):
        if character in ODD_SPACES:
            return place, f'{ODD_SPACES[character]} (U+{ord(character):04X})'
    return None


def _merge_conflict(lines: list[Line]) -> Found | None:
    for line in lines:
        if line.column == 1 and line.text.startswith('<<<<<<< '):
            message = (
                'a merge conflict of git begins here; keep one of its two sides, and remove the '
                'lines that begin with <<<<<<<, ======= and >>>>>>>'
            )
            return line.number, 1, message
    return None


def _odd_space(near: list[Line], text: str) -> Found | None:
    all_lines = lines_of(text)
    for line in near:
        if found := odd_space(all_lines[line.number - 1]):
            return line.number, found[0] + 1, f'{found[1]}; write plain spaces'
    return None


def _unclosed(error: yaml.MarkedYAMLError, text: str) -> Found | None:
    """Tell of a bracket or a quote that has no end, and of a comma that is missing."""
    context = error.context or ''
    if error.context_mark is None or error.problem_mark is None:
        return None
    begin, end = error.context_mark, error.problem_mark
    opened = lines_of(text)[begin.line][begin.column : begin.column + 1]
    if 'quoted scalar' in context:
        return begin.line + 1, begin.column + 1, f'the {opened} that begins here has no end'
    if opened in ('[', '{') and 'flow' in context:
        closing = {'[': ']', '{': '}'}[opened]
        if end.line == begin.line:
            message = f'a comma or the {closing} is missing before this'
            return end.line + 1, end.column + 1, message
        return begin.line + 1, begin.column + 1, f'the {opened} has no {closing} in this line'
    return None


def _dash(line: Line) -> Found | None:
    """Tell of an item without a space behind its dash, which YAML takes for text."""
    if not _NO_ITEM.match(line.text):
        return None
    return line.number, line.column + 1, f"a space is missing; write '- {line.text[1:]}'"


def _colon(line: Line) -> Found | None:
    """Tell of a field without a colon, or without a space behind it."""
    column, text = line.inner
    if found := _NO_SPACE.match(text):
        message = f"a space is missing; write '{found[1]}: {found[2]}'"
        return line.number, column + len(found[1]) + 1, message
    if found := _NO_COLON.match(text):
        message = f"a colon is missing; write '{found[1]}: {found[2]}'"
        return line.number, column + len(found[1]), message
    return None


def _two_fields(error: yaml.MarkedYAMLError, near: list[Line]) -> Found | None:
    place = error.problem_mark
    if place is None or 'mapping values' not in (error.problem or ''):
        return None
    for line in near:
        keys = list(re.finditer(r'(?<!\S)[A-Za-z_]\w*(?=:(?:\s|$))', line.text))
        if line.number == place.line + 1 and len(keys) > 1:
            message = (
                f'{keys[1][0]} is a second field in this line; give it a line of its own, or put '
                f'the text after {keys[0][0]}: in quotes'
            )
            return line.number, line.column + keys[1].start(), message
        if line.number == place.line + 1 and _COLON_IN_TEXT.match(line.inner[1]):
            message = f'a text with a colon in it; put all that stands after {line.key}: in quotes'
            return line.number, place.column + 1, message
    return None


def _first_dash(item: Line, above: list[Line]) -> Found | None:
    """Tell of fields before the first item of a list, which lack its dash."""
    before = list(takewhile(lambda line: line.column >= item.column, reversed(above)))
    if not before or before[-1].column != item.column:
        return None
    first = before[-1]
    return first.number, first.column, f"a dash is missing; write '- {first.text}'"


def _column(lines: list[Line], problem: int) -> Found | None:
    """Tell of a line that begins in another column than those that it belongs to."""
    at = next((place for place, line in enumerate(lines) if line.number >= problem), None)
    if at is None:
        return None
    if lines[at].text.startswith(('[', '{')):
        while at and lines[at - 1].text.startswith(('[', '{')):
            at -= 1
        line = lines[at]
        return line.number, line.column, f"a dash is missing; write '- {line.text}'"
    line, above = lines[at], lines[:at]
    if line.is_item:
        what = 'the dash'
        columns = [(other, other.column) for other in above if other.is_item]
    else:
        what = line.key
        columns = [(other, other.inner[0]) for other in above if other.key]
    if line.is_item and not columns:
        return _first_dash(line, above)
    if not what or not columns:
        return None
    # The nearest column is meant, of several lines there the last.
    other, meant = min(reversed(columns), key=lambda each: abs(each[1] - line.column))
    if meant == line.column:
        return None
    if other is lines[0] and meant > 1:
        return other.number, meant, f'begins in column {meant}; begin in column 1'
    whose = 'that' if line.is_item else other.key
    message = (
        f'{what} stands in column {line.column}, but {whose} of line {other.number} in column '
        f'{meant}; write both in the same column'
    )
    return line.number, line.column, message
