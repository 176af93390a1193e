# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How many nodes of a name a launch has started."""

from __future__ import annotations

from launch.launch_context import LaunchContext

_KEY = 'unique_ros_node_names'


def add_node_name(context: LaunchContext, node_name: str) -> None:
    counts = context.get_locals_as_dict().get(_KEY)
    if counts is None:
        counts = {}
        context.extend_globals({_KEY: counts})
    counts[node_name] = counts.get(node_name, 0) + 1


def get_node_name_count(context: LaunchContext, node_name: str) -> int:
    counts: dict[str, int] = context.get_locals_as_dict().get(_KEY, {})
    return counts.get(node_name, 0)
