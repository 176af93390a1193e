# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Watches the graph of a live run for why the controller's commands cannot be heard."""

from collections.abc import Iterator
import time
from typing import Any

from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

WANTED_TYPE = 'geometry_msgs/msg/Twist'
VELOCITY_TYPES = (WANTED_TYPE, 'geometry_msgs/msg/TwistStamped')
COMMAND_TOPIC = '/husky_velocity_controller/cmd_vel'
OWN_TOPIC = f'{COMMAND_TOPIC}_out'  # the simulator's; all other velocities are the controller's


class GraphWatcher:
    """Keeps hints about the controller, as the simulator's node sees it."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._hinting_since_sec: float | None = None
        self.hints: list[str] = []

    def check(self) -> None:
        """Look at the graph; hints are kept, because nodes may come and go."""
        hints = list(self._wrong_commands())
        if not hints:
            self._hinting_since_sec = None
        elif self._hinting_since_sec is None:
            self._hinting_since_sec = time.monotonic()
        self.hints = hints or self.hints

    def hinting_sec(self) -> float:
        """Return for how long every look at the graph has found something wrong."""
        since = self._hinting_since_sec
        return 0.0 if since is None else time.monotonic() - since

    def _wrong_commands(self) -> Iterator[str]:
        """Yield what is wrong with how the controller publishes commands."""
        publishers = self._node.get_publishers_info_by_topic(COMMAND_TOPIC)
        for info in publishers:
            yield from _wrong(info)
        if publishers:
            return
        for name, kinds in sorted(self._node.get_topic_names_and_types()):
            velocity = [kind for kind in kinds if kind in VELOCITY_TYPES]
            others = name not in (COMMAND_TOPIC, OWN_TOPIC)
            if velocity and others and self._node.count_publishers(name):
                yield f'it publishes {velocity[0]} on {name}; the Husky listens on {COMMAND_TOPIC}'


def _wrong(info: Any) -> Iterator[str]:
    if info.topic_type != WANTED_TYPE:
        yield f'it publishes {info.topic_type} on {COMMAND_TOPIC}; the Husky takes {WANTED_TYPE}'
    if info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT:
        yield (
            f'it publishes {COMMAND_TOPIC} best effort; the Husky listens reliably and hears '
            'nothing'
        )
