# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tests of output for LaunchTestService, on bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import io
import os
from pathlib import Path
import re
from typing import TypeVar

import ament_index_python

_Pattern = TypeVar('_Pattern', bytes, re.Pattern[bytes])
_Collate = Callable[[io.BytesIO, bytes], io.BytesIO]
# An empty output, what adds to it, what looks for one of the patterns, and the patterns.
OutputTest = tuple[io.BytesIO, _Collate, Callable[[io.BytesIO, _Pattern], bool], list[_Pattern]]


def get_default_filtered_prefixes() -> list[bytes]:
    return [b'pid', b'rc']


def get_default_filtered_patterns() -> list[bytes]:
    return []


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[bytes]:
    """Return what a middleware writes by itself: 'prefixes' or 'patterns' of lines.

    :raises TypeError: it is asked for something else.
    """
    if filter_type not in ('prefixes', 'patterns'):
        raise TypeError(f"filter_type={filter_type!r}: it must be 'prefixes' or 'patterns'")
    resource = f'rmw_output_{filter_type}'
    if not ament_index_python.has_resource(resource, rmw_implementation):
        return []
    lines, _ = ament_index_python.get_resource(resource, rmw_implementation)
    return [line.encode() for line in lines.splitlines()]


def create_output_lines_filter(
    filtered_prefixes: list[bytes] | None = None,
    filtered_patterns: list[bytes] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[bytes], bytes]:
    """Return a function that leaves lines out; see launch_testing.tools.basic_output_filter."""
    prefixes = list(filtered_prefixes or get_default_filtered_prefixes())
    expressions = list(filtered_patterns or get_default_filtered_patterns())
    if filtered_rmw_implementation:
        prefixes += get_rmw_output_filter(filtered_rmw_implementation, 'prefixes')
        expressions += get_rmw_output_filter(filtered_rmw_implementation, 'patterns')
    patterns = [re.compile(expression) for expression in expressions]
    separator = os.linesep.encode()

    def filter_output(output: bytes) -> bytes:
        kept = [
            line
            for line in output.splitlines()
            if not line.startswith(tuple(prefixes))
            if not any(pattern.match(line) for pattern in patterns)
        ]
        if output.endswith(separator):
            kept.append(separator)
        return separator.join(kept)

    return filter_output


def create_output_lines_test(expected_lines: Iterable[bytes]) -> OutputTest[bytes]:
    """Return a test that each of these is a part of some line."""

    def collate(output: io.BytesIO, addition: bytes) -> io.BytesIO:
        output.write(addition)
        return output

    def match(output: io.BytesIO, expected: bytes) -> bool:
        return any(expected in line for line in output.getvalue().splitlines())

    return io.BytesIO(), collate, match, list(expected_lines)


def create_output_regex_test(
    expected_patterns: Iterable[re.Pattern[bytes]],
) -> OutputTest[re.Pattern[bytes]]:
    """Return a test that each of these patterns is found."""

    def collate(output: io.BytesIO, addition: bytes) -> io.BytesIO:
        output.write(b'\n'.join(addition.splitlines()))
        return output

    def match(output: io.BytesIO, pattern: re.Pattern[bytes]) -> bool:
        return pattern.search(output.getvalue()) is not None

    return io.BytesIO(), collate, match, list(expected_patterns)


def create_output_test_from_file(
    output_file: str,
) -> OutputTest[bytes] | OutputTest[re.Pattern[bytes]]:
    """Return a test of the lines in FILE.txt, or else of the patterns in FILE.regex.

    :raises RuntimeError: there is neither.
    """
    text, patterns = Path(f'{output_file}.txt'), Path(f'{output_file}.regex')
    if text.is_file():
        return create_output_lines_test(text.read_bytes().splitlines())
    if patterns.is_file():
        lines = patterns.read_bytes().splitlines()
        return create_output_regex_test(re.compile(line) for line in lines)
    raise RuntimeError(f'could not find output check file: {output_file} (.txt or .regex)')
