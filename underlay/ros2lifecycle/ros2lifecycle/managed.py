# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What makes a node one with a lifecycle; read from the graph, without rclpy."""

from __future__ import annotations

from collections.abc import Mapping

from rtps_graph.graph import Node, Role


def has_lifecycle(node_name: str, services: Mapping[str, list[str]]) -> bool:
    """Tell whether one of the services, their types by their names, is a lifecycle node's."""
    return 'lifecycle_msgs/srv/GetState' in services.get(f'{node_name}/get_state', [])


def is_managed(node: Node) -> bool:
    """Tell whether a node in the graph has a lifecycle."""
    return has_lifecycle(node.full_name, node.having(Role.SERVER))
