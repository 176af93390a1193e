# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell on a topic that a file of a bag is complete, so that others may take it away."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ros2cli.node.direct import CommandNode
from rosbag2_interfaces.msg import WriteSplitEvent


def teller(node: CommandNode) -> Callable[[Path, Path | None], None]:
    """Return what publishes which file was closed, and which was opened in its place."""
    publisher = node.node.create_publisher(WriteSplitEvent, 'events/write_split', 1)

    def tell(closed: Path, opened: Path | None) -> None:
        event = WriteSplitEvent()
        event.closed_file = str(closed)
        event.opened_file = str(opened or '')
        event.node_name = node.node.get_fully_qualified_name()
        publisher.publish(event)

    return tell
