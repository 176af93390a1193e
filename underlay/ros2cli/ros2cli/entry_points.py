# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Entry points as upstream's packages ask for them; `ros2` itself uses the quicker index."""

from __future__ import annotations

from collections.abc import Collection
from importlib import metadata
import inspect
import logging
from typing import Any

# In it, packages register the groups by which others extend them.
EXTENSION_POINT_GROUP_NAME = 'ros2cli.extension_point'

_LOGGER = logging.getLogger(__name__)


def get_all_entry_points() -> dict[str, dict[str, tuple[metadata.Distribution, Any]]]:
    """Map the registered groups to their entry points by name, each with its distribution."""
    groups = get_entry_points(EXTENSION_POINT_GROUP_NAME)
    found: dict[str, dict[str, tuple[metadata.Distribution, Any]]] = {}
    for distribution in metadata.distributions():
        for entry_point in distribution.entry_points:
            if entry_point.group in groups:
                group = found.setdefault(entry_point.group, {})
                group[entry_point.name] = distribution, entry_point
    return found


def get_entry_points(group_name: str) -> dict[str, metadata.EntryPoint]:
    """Map the names in a group to their entry points."""
    return {each.name: each for each in metadata.entry_points(group=group_name)}


def load_entry_points(
    group_name: str, *, exclude_names: Collection[str] | None = None
) -> dict[str, Any]:
    """Map the names in a group to what they name; a warning is logged for what does not load."""
    loaded = {}
    for name, entry_point in get_entry_points(group_name).items():
        if name in (exclude_names or ()):
            continue
        try:
            loaded[name] = entry_point.load()
        except Exception as error:
            _LOGGER.warning("Failed to load entry point '%s': %s", name, error)
    return loaded


def get_first_line_doc(any_type: Any) -> str:
    """Return the first line of a docstring without its full stop."""
    return (inspect.getdoc(any_type) or '').partition('\n')[0].strip().rstrip('.')
