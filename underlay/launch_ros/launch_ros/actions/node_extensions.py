# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Plugins that take part in the start of each node."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TYPE_CHECKING

from entry_point_index import entry_points, load
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType

from ..utilities.plugin_support import satisfies_version

if TYPE_CHECKING:
    from .node import Node

_GROUP = 'launch_ros.node_action'


class NodeActionExtension:
    """Base of the plugins, which are entry points of the group ``launch_ros.node_action``."""

    NAME: str | None = None  # that of the entry point
    EXTENSION_POINT_VERSION = '0.1'

    def __init__(self) -> None:
        satisfies_version(self.EXTENSION_POINT_VERSION, '^0.1')

    def prepare_for_execute(
        self, context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Node
    ) -> tuple[Iterable[SomeSubstitutionsType], dict[str, Any]]:
        """Return words to add to the command, and the arguments with the node's name, changed.

        :param ros_specific_arguments: ``name`` and ``ns`` as they follow ``-r``.
        """
        del context, node_action
        return [], ros_specific_arguments


def get_extensions(logger: Any) -> dict[str, NodeActionExtension]:
    """Return the installed plugins by name; what fails to load is warned about."""
    extensions = {}
    for name, target in entry_points(_GROUP).items():
        try:
            extension = load(target)()
        except Exception as error:
            logger.warning(f"Failed to load the node extension '{name}': {error}")
            continue
        extension.NAME = name
        extensions[name] = extension
    return extensions
