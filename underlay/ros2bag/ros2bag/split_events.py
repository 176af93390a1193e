# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell on a topic that a file of a bag is done with, and which one follows it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rclpy.duration import Duration
from ros2cli.node.direct import CommandNode
from rosbag2_interfaces.msg import ReadSplitEvent, WriteSplitEvent

_ARRIVAL = Duration(seconds=0.5)  # a process that stands still acknowledges nothing

Tell = Callable[[Path, Path | None], None]
"""Publishes which file was closed, and which was opened in its place."""


def of_recorder(node: CommandNode) -> Tell:
    """Return what tells that a file is complete, so that others may take it away."""
    return _teller(node, WriteSplitEvent, 'events/write_split')


def of_player(node: CommandNode) -> Tell:
    """Return what tells that a file was read to its end."""
    return _teller(node, ReadSplitEvent, 'events/read_split')


def _teller(node: CommandNode, kind: Any, topic: str) -> Tell:
    publisher = node.node.create_publisher(kind, topic, 1)

    def tell(closed: Path, opened: Path | None) -> None:
        event = kind()
        event.closed_file = str(closed)
        event.opened_file = str(opened or '')
        event.node_name = node.node.get_fully_qualified_name()
        publisher.publish(event)
        if opened is None:  # the node ends soon, and with it what has not arrived
            publisher.wait_for_all_acked(_ARRIVAL)

    return tell
