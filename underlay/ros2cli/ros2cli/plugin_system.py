# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The interface between `ros2` and the packages that extend it."""

from __future__ import annotations

import argparse
from collections import OrderedDict
from collections.abc import Callable, Collection, Mapping
from typing import Any

PLUGIN_SYSTEM_VERSION = '0.1'

_instances: dict[type, Any] = {}


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


def instantiate_extensions(
    group_name: str,
    *,
    exclude_names: Collection[str] | None = None,
    unique_instance: bool = False,
) -> dict[str, Any]:
    """Map the names of an entry point group to instances; what fails is logged and left out.

    :param unique_instance: make new ones, not those that the process has already.
    """
    import logging

    from ros2cli.entry_points import load_entry_points

    instances = {}
    for name, kind in load_entry_points(group_name, exclude_names=exclude_names).items():
        try:
            instance = _instances[kind] if kind in _instances and not unique_instance else kind()
        except Exception as error:
            level = logging.WARNING if isinstance(error, PluginException) else logging.ERROR
            logging.getLogger(__name__).log(
                level, "Failed to instantiate '%s' extension '%s': %s", group_name, name, error
            )
            continue
        if not unique_instance:
            _instances[kind] = instance
        instances[name] = instance
    return instances


def named_extensions(
    group_name: str, *, exclude_names: Collection[str] | None = None
) -> dict[str, Any]:
    """Instantiate as above, and tell each extension its name."""
    extensions = instantiate_extensions(group_name, exclude_names=exclude_names)
    for name, extension in extensions.items():
        extension.NAME = name
    return extensions


def order_extensions(
    extensions: Mapping[str, Any],
    key_function: Callable[[tuple[str, Any]], Any],
    *,
    reverse: bool = False,
) -> OrderedDict[str, Any]:
    return OrderedDict(sorted(extensions.items(), key=key_function, reverse=reverse))


def order_extensions_by_name(extensions: Mapping[str, Any]) -> OrderedDict[str, Any]:
    return order_extensions(extensions, lambda item: item[0])


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split('.'))
