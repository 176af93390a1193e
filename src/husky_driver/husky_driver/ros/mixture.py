# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Who else commands the robot, such as a teleop in a forgotten terminal."""

from rclpy.node import Node
from rclpy.publisher import Publisher


def others_that_command(node: Node, commands: Publisher) -> str:
    """Return who publishes beside this node what the robot takes; nothing where nobody does."""
    topic = commands.topic_name
    infos = node.get_publishers_info_by_topic(topic)
    names = [f'{info.node_namespace.rstrip("/")}/{info.node_name}' for info in infos]
    if node.get_fully_qualified_name() in names:
        names.remove(node.get_fully_qualified_name())
    if not names:
        return ''
    who = ' and '.join(sorted(names))
    also = 'also publishes' if len(names) == 1 else 'also publish'
    return f'{who} {also} {topic}, so that the robot gets a mixture of commands'
