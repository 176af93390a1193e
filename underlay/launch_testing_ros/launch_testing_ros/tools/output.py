# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Filter what a middleware writes out of the output of nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
import re

from launch_testing.legacy import output as output_in_bytes
from launch_testing.tools import output


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[str]:
    """Return what a middleware writes by itself: 'prefixes' or 'patterns' of lines.

    :raises TypeError: it is asked for something else.
    """
    lines = output_in_bytes.get_rmw_output_filter(rmw_implementation, filter_type)
    return [line.decode() for line in lines]


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str | re.Pattern[str]] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that leaves lines out; see launch_testing.tools.basic_output_filter.

    :param filtered_rmw_implementation: the middleware whose own lines are left out too.
    """
    prefixes = filtered_prefixes
    if prefixes is None:
        prefixes = output.get_default_filtered_prefixes()
    patterns = filtered_patterns
    if patterns is None:
        patterns = output.get_default_filtered_patterns()
    if filtered_rmw_implementation:
        rmw = filtered_rmw_implementation
        prefixes = [*prefixes, *get_rmw_output_filter(rmw, 'prefixes')]
        patterns = [*patterns, *get_rmw_output_filter(rmw, 'patterns')]
    return output.basic_output_filter(prefixes, patterns)
