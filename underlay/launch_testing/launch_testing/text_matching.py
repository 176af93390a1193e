# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Match output with what a test expects of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
import os
import re
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from launch.events.process import ProcessIO

Expected = str | re.Pattern[str] | Iterable[str | re.Pattern[str]]
Span = tuple[int, int]
# Of what is searched and where to start: where the match begins and ends, or None.
TextMatch = Callable[..., Span | None]


def decode_output(events: Iterable[ProcessIO]) -> str:
    """Return the text of events, of which each may end amid a character."""
    return b''.join(event.text for event in events).decode(errors='replace')


def normalize_lineseps(lines: str) -> str:
    """Return text with line feeds alone; a process at a terminal writes others."""
    return lines.replace(os.linesep, '\n').replace('\r\n', '\n')


def build_text_match(expected_text: Expected, *, strict: bool = False) -> TextMatch:
    """Return a function that searches text for what is expected.

    :param expected_text: text, a pattern, or several of them, each to come after the one before.
    :param strict: it must stand right at the start; plain text must be all that there is.
    :raises ValueError: what is expected is none of these.
    """
    if isinstance(expected_text, str):
        match = _match_plain_text(expected_text, strict)
    elif isinstance(expected_text, re.Pattern):
        match = _match_pattern(expected_text, strict)
    elif isinstance(expected_text, Iterable):
        return _match_in_order([build_text_match(each) for each in expected_text], strict)
    else:
        raise ValueError(
            f'expected_text={expected_text!r}: expected is text, a pattern or a list of these'
        )
    return lambda actual_text, start=0: match(normalize_lineseps(actual_text), start)


def build_line_match(expected_lines: Expected, *, strict: bool = False) -> TextMatch:
    """Return a function that searches a list of lines for what is expected.

    :param expected_lines: a part of a line, a pattern that a line begins with, or several of
        these, each for a line after the one before.
    :param strict: text must be every line, a pattern must match every line; several must match
        the first lines with none left out.
    :raises ValueError: what is expected is none of these.
    """
    if isinstance(expected_lines, str):
        if strict:
            return _match_every_line(lambda line: line == expected_lines)
        return _match_one_line(lambda line: expected_lines in line)
    if isinstance(expected_lines, re.Pattern):
        build = _match_every_line if strict else _match_one_line
        return build(lambda line: expected_lines.match(line) is not None)
    if isinstance(expected_lines, Iterable):
        return _match_in_order([build_line_match(each) for each in expected_lines], strict)
    raise ValueError(
        f'expected_lines={expected_lines!r}: expected is text, a pattern or a list of these'
    )


def _match_plain_text(expected: str, strict: bool) -> Callable[[str, int], Span | None]:
    def match(text: str, start: int) -> Span | None:
        if strict:
            return (start, len(text)) if text[start:] == expected else None
        found = text.find(expected, start)
        return None if found < 0 else (found, found + len(expected))

    return match


def _match_pattern(pattern: re.Pattern[str], strict: bool) -> Callable[[str, int], Span | None]:
    def match(text: str, start: int) -> Span | None:
        found = pattern.match(text, start) if strict else pattern.search(text, start)
        return None if found is None else found.span()

    return match


def _match_one_line(holds: Callable[[str], bool]) -> TextMatch:
    def match(lines: Sequence[str], start: int = 0) -> Span | None:
        numbers = range(start, len(lines))
        return next(((each, each + 1) for each in numbers if holds(lines[each])), None)

    return match


def _match_every_line(holds: Callable[[str], bool]) -> TextMatch:
    def match(lines: Sequence[str], start: int = 0) -> Span | None:
        return (start, len(lines)) if all(map(holds, lines[start:])) else None

    return match


def _match_in_order(matches: Sequence[TextMatch], strict: bool) -> TextMatch:
    def match(actual: Any, start: int = 0) -> Span | None:
        first, end = None, start
        for each in matches:
            span = each(actual, end)
            if span is None or (strict and span[0] != end):
                return None
            first, end = span[0] if first is None else first, span[1]
        return start if first is None else first, end

    return match
