# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why no odometry comes that could be answered."""

from collections.abc import Callable
import os

from husky_runtime.shared_memory import lacks_shared_memory, OF_A_NODE_MB
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription


def what_is_missing(node: Node, odometry: Subscription, commands: Publisher) -> str:
    """Return who is not there, and what to look at."""
    domain = os.environ.get('ROS_DOMAIN_ID', '0')
    where = f'is the simulator running, with ROS_DOMAIN_ID={domain} as here?'
    if os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE') == 'OFF':
        where = (
            'by ROS_AUTOMATIC_DISCOVERY_RANGE=OFF nodes do not find each other: '
            '`export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`'
        )
    elif server := os.environ.get('ROS_DISCOVERY_SERVER'):
        where = f'is the discovery server running, as ROS_DISCOVERY_SERVER={server} has it?'
    if odometry.get_publisher_count() == 0:
        there = in_another_namespace(node, odometry.topic_name, node.count_publishers)
        return f'nobody publishes {odometry.topic_name}; {there or where}'
    if commands.get_subscription_count() == 0:
        there = in_another_namespace(node, commands.topic_name, node.count_subscribers)
        return f'nobody listens to {commands.topic_name}; {there or where}'
    if lacks_shared_memory(OF_A_NODE_MB):
        return (
            f'{odometry.topic_name} is silent; messages get lost where /dev/shm is full: remove '
            'what is not needed there, and start the simulator again'
        )
    return f'{odometry.topic_name} is silent; is the simulation paused, or that of another user?'


def in_another_namespace(node: Node, topic: str, count: Callable[[str], int]) -> str:
    """Say in which namespace a topic is that a node looks for in vain; nothing where in none.

    :param count: how many there are of those that the node looks for, by the name of a topic.
    """
    relative = topic.removeprefix(node.get_namespace().rstrip('/'))
    names = [name for name, _ in node.get_topic_names_and_types() if name.endswith(relative)]
    there = [name.removesuffix(relative) or '/' for name in names if name != topic and count(name)]
    if not there:
        return ''
    return f'it is in the namespace {", ".join(there)}: write `--ros-args -r __ns:={there[0]}`'
