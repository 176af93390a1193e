# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Filter output, and compare it with what is expected."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
import re

from osrf_pycommon.terminal_color import remove_ansi_escape_sequences

from ..text_matching import build_line_match, build_text_match, Expected


def get_default_filtered_prefixes() -> list[str]:
    return ['pid', 'rc']


def get_default_filtered_patterns() -> list[str]:
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str | re.Pattern[str]] | None = None,
) -> Callable[[str], str]:
    """Return a function that leaves lines out of text.

    :param filtered_prefixes: left out is what begins so; by default process ids and return codes.
    :param filtered_patterns: left out is what a pattern matches from its start on.
    """
    if filtered_prefixes is None:
        filtered_prefixes = get_default_filtered_prefixes()
    if filtered_patterns is None:
        filtered_patterns = get_default_filtered_patterns()
    prefixes = tuple(filtered_prefixes)
    patterns = [re.compile(pattern) for pattern in filtered_patterns]

    def filter_output(output: str) -> str:
        return ''.join(
            line
            for line in output.splitlines(keepends=True)
            if not line.startswith(prefixes)
            if not any(pattern.match(line) for pattern in patterns)
        )

    return filter_output


def expected_output_from_file(
    path: str, encoding: str | None = None
) -> list[str] | list[re.Pattern[str]]:
    """Read the lines to expect from PATH.txt, or else patterns from PATH.regex.

    :raises RuntimeError: there is neither.
    """
    text, patterns = Path(f'{path}.txt'), Path(f'{path}.regex')
    if text.is_file():
        return text.read_text(encoding=encoding).splitlines()
    if patterns.is_file():
        return [re.compile(line) for line in patterns.read_text(encoding=encoding).splitlines()]
    raise RuntimeError(f'could not find output check file: {path} (.txt or .regex)')


def expect_output(
    text: str | None = None,
    *,
    lines: Iterable[str] | None = None,
    expected_text: Expected | None = None,
    expected_lines: Expected | None = None,
    strip_ansi_escape_sequences: bool = True,
    strict: bool = False,
) -> bool:
    """Return whether output is as expected, see build_text_match and build_line_match.

    :param text: the output; or give its lines.
    :raises ValueError: of text and lines, or of what is expected, both are given or none.
    """
    if (text is None) == (lines is None):
        raise ValueError('either text or lines must be given, and not both')
    if (expected_text is None) == (expected_lines is None):
        raise ValueError('either expected_text or expected_lines must be given, and not both')
    actual = '\n'.join(lines) if lines is not None else text or ''
    if strip_ansi_escape_sequences:
        actual = remove_ansi_escape_sequences(actual)
    if expected_text is not None:
        return build_text_match(expected_text, strict=strict)(actual) is not None
    assert expected_lines is not None
    return build_line_match(expected_lines, strict=strict)(actual.splitlines()) is not None
