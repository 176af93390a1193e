# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether a plugin fits what it plugs into."""

from __future__ import annotations


class PluginException(Exception):
    """Raised where a plugin cannot be used."""


def satisfies_version(version: str, caret_range: str) -> None:
    """Check the version of an extension point, as '0.1', against a range, as '^0.1'.

    :raises PluginException: it is lower, or differs in the first number that is not 0.
    """
    lowest = _numbers(caret_range.removeprefix('^'))
    found = _numbers(version)
    if found < lowest:
        raise PluginException(f"Extension point {version} is older than '{caret_range}'")
    if found >= ((lowest[0] + 1, 0) if lowest[0] else (0, lowest[1] + 1)):
        raise PluginException(f"Extension point {version} is newer than '{caret_range}'")


def _numbers(version: str) -> tuple[int, int]:
    major, minor, *_ = (*version.split('.'), '0')
    return int(major), int(minor)
