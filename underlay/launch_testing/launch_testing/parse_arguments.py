# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch arguments of a command line."""

from __future__ import annotations

from collections.abc import Iterable


def parse_launch_arguments(launch_arguments: Iterable[str]) -> list[tuple[str, str]]:
    """Split words of the form name:=value; of duplicates the last wins.

    :raises RuntimeError: a word has another form.
    """
    parsed: dict[str, str] = {}
    for word in launch_arguments:
        name, separator, value = word.partition(':=')
        if not separator or not name or not value:
            raise RuntimeError(
                f"malformed launch argument '{word}', expected format '<name>:=<value>'"
            )
        parsed[name] = value
    return list(parsed.items())
