# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The version of the interface between `ros2` and the packages that extend it."""

from __future__ import annotations

import argparse

PLUGIN_SYSTEM_VERSION = '0.1'


class PluginException(Exception):
    """Raised when an extension was written for another version of the interface."""


def satisfies_version(version: str, caret_range: str) -> None:
    """Check a version against a range such as '^0.1'.

    :raises PluginException: the version is outside the range.
    :raises ValueError: the range begins with something else than '^'.
    """
    if not caret_range.startswith('^'):
        raise ValueError(f"'{caret_range}' is refused: a range begins with '^', as in '^0.1'")
    have, want = _numbers(version), _numbers(caret_range[1:])
    # Before 1.0 the second number counts as the first one does later.
    fixed = 1 if want[0] else 2
    if have < want or have[:fixed] != want[:fixed]:
        raise PluginException(
            f"the interface has version {version}, but the extension needs '{caret_range}'"
        )


class Extension:
    """Base of commands and verbs; the docstring of each is its help."""

    NAME: str | None = None
    EXTENSION_POINT_VERSION = '0.1'

    def __init__(self) -> None:
        satisfies_version(PLUGIN_SYSTEM_VERSION, '^0.1')

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        pass


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split('.'))
