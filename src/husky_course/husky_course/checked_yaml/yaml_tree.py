# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Read YAML into a small tree that remembers where every value stands.

Works on the parser's events instead of on composed nodes: aliases, tags and deep nesting are
refused before they can cost time or stack.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import yaml

from husky_course.checked_yaml.layout import explain, lines_of
from husky_course.files import first_bytes
from husky_course.printable import printable

MAX_BYTES = 100_000
MAX_DEPTH = 8
MAX_MESSAGE = 1000  # characters; some hold a word of the file, which may be all of that


@dataclass(frozen=True, order=True)
class Problem:
    """One thing that is wrong in a file; lines and columns count from 1, or are 0: of the file."""

    line: int
    column: int
    field: str
    message: str

    def text(self, file: str) -> str:
        field = f'{self.field}: ' if self.field else ''
        place = f'line {self.line}, column {self.column}: ' if self.line else ''
        told = self.message
        if len(told) > MAX_MESSAGE:
            told = f'{told[: MAX_MESSAGE - 3]}...'
        return f'{file}: {place}{field}{told}'


class FileRefused(ValueError):
    """A file that cannot be used, with every reason."""

    def __init__(self, file: str, problems: list[Problem]) -> None:
        self.file = file
        self.problems = tuple(sorted(problems))
        name = printable(file)  # on one line, so that a problem is one line
        super().__init__('\n'.join(problem.text(name) for problem in self.problems))


@dataclass(frozen=True)
class Value:
    """A scalar, list or mapping, and where it begins."""

    line: int
    column: int
    kind: str  # 'scalar', 'list' or 'mapping'
    text: str = ''
    quoted: bool = False
    items: tuple[Value, ...] = ()
    pairs: tuple[tuple[Value, Value], ...] = ()

    def __str__(self) -> str:
        """Return the value as a person would say it, cut to a length that fits a line."""
        if self.kind == 'list':
            return f'a list of {len(self.items)}'
        if self.kind == 'mapping':
            return f'a mapping of {len(self.pairs)}'
        if self.text == '' and not self.quoted:
            return 'nothing'
        shown = self.text if len(self.text) <= 40 else self.text[:37] + '...'
        return repr(shown) if self.quoted or not shown.isprintable() else shown


def read_yaml(path: Path) -> Value:
    """
    Return the only document of a YAML file.

    :raises FileRefused: when it cannot be read, is too large or is not plain YAML.
    """
    name = str(path)
    return parse_yaml(_read_text(path, name), name)


def _read_text(path: Path, name: str) -> str:
    def refused(message: str, line: int = 1, column: int = 1) -> FileRefused:
        return FileRefused(name, [Problem(line, column, '', message)])

    try:
        if path.is_symlink() and not path.exists():
            to = str(path.readlink())
            raise refused(f'a link to {to!r}, where no file is; give the file itself', 0, 0)
        if not path.exists():
            raise refused(f'no such file{_nearest_file(path)}', 0, 0)
        if not path.is_file():
            raise refused('not a file; give the path of one .yaml file', 0, 0)
        data = first_bytes(path, MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the path
        if isinstance(error, FileRefused):
            raise
        reason = getattr(error, 'strerror', None) or str(error)
        raise refused(f'cannot be read: {reason}', 0, 0) from None
    if len(data) > MAX_BYTES:
        raise refused(f'larger than {MAX_BYTES} bytes; 1000 waypoints need less')
    try:
        return data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        lines = data[: error.start].split(b'\n')
        message = f'byte 0x{data[error.start]:02x} is not UTF-8 text; save the file as UTF-8'
        raise refused(message, len(lines), len(lines[-1]) + 1) from None


def _nearest_file(path: Path) -> str:
    from difflib import get_close_matches

    try:
        # The Editor of Windows adds .txt, and the Explorer does not show it.
        found = {other.name for end in ('', '.txt') for other in path.parent.glob(f'*.y*ml{end}')}
    except OSError:
        return ''
    near = get_close_matches(path.name, sorted(found), n=1, cutoff=0.5)
    return f'; did you mean {path.parent / near[0]}?' if near else ''


def parse_yaml(text: str, name: str) -> Value:
    """Return the only document of a YAML text; see `read_yaml`."""
    try:
        return _Builder(name).document(yaml.parse(text, Loader=yaml.SafeLoader))
    except yaml.reader.ReaderError as error:
        lines = lines_of(text[: error.position])
        code = error.character if isinstance(error.character, int) else ord(error.character)
        message = f'character U+{code:04X} is not allowed; remove it'
        raise FileRefused(name, [Problem(len(lines), len(lines[-1]) + 1, '', message)]) from None
    except yaml.MarkedYAMLError as error:
        raise FileRefused(name, [_syntax_problem(error, text)]) from None
    except (ValueError, RecursionError) as error:
        # PyYAML lets some broken escapes and version directives out as plain ValueError.
        if isinstance(error, FileRefused):
            raise
        raise FileRefused(name, [Problem(1, 1, '', f'not valid YAML: {error}')]) from None


def _syntax_problem(error: yaml.MarkedYAMLError, text: str) -> Problem:
    if found := explain(error, text):
        line, column, message = found
        return Problem(line, column, '', message)
    mark = error.problem_mark or error.context_mark
    line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
    problem = ' '.join(str(error.problem or error.context or 'cannot be understood').split())
    context = f' ({" ".join(error.context.split())})' if error.problem and error.context else ''
    return Problem(line, column, '', f'not valid YAML: {problem}{context}')


class _Builder:
    """Turns events into values, without recursion deeper than MAX_DEPTH."""

    def __init__(self, name: str) -> None:
        self._name = name

    def document(self, events: Iterator[yaml.Event]) -> Value:
        root: Value | None = None
        for event in events:
            if isinstance(event, yaml.DocumentStartEvent):
                if root is not None:
                    raise self._refused(event, "a second document ('---'); keep only one")
                root = self._value(next(events), events, 1)
        return root or Value(1, 1, 'scalar')

    def _value(self, event: yaml.Event, events: Iterator[yaml.Event], depth: int) -> Value:
        if isinstance(event, yaml.AliasEvent):
            raise self._refused(event, f"alias '*{event.anchor}' is not allowed; write it out")
        anchor, tag = getattr(event, 'anchor', None), getattr(event, 'tag', None)
        if anchor is not None:
            raise self._refused(event, f"anchor '&{anchor}' is not allowed; write values out")
        if tag not in (None, '!'):
            raise self._refused(event, f'tag {tag!r} is not allowed; write plain values')
        line, column = _place(event)
        if isinstance(event, yaml.ScalarEvent):
            quoted = event.style is not None
            return Value(line, column, 'scalar', text=event.value, quoted=quoted)
        if depth > MAX_DEPTH:
            raise self._refused(event, f'nested deeper than {MAX_DEPTH} levels')
        items = list(self._children(events, depth))
        if isinstance(event, yaml.SequenceStartEvent):
            return Value(line, column, 'list', items=tuple(items))
        pairs = tuple(zip(items[::2], items[1::2], strict=True))
        return Value(line, column, 'mapping', pairs=pairs)

    def _children(self, events: Iterator[yaml.Event], depth: int) -> Iterator[Value]:
        for event in events:
            if isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
                return
            yield self._value(event, events, depth + 1)

    def _refused(self, event: yaml.Event, message: str) -> FileRefused:
        return FileRefused(self._name, [Problem(*_place(event), '', message)])


def _place(event: yaml.Event) -> tuple[int, int]:
    mark = event.start_mark
    return (mark.line + 1, mark.column + 1) if mark else (1, 1)
