# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Subscribe to what is to be recorded, and write it down."""

from __future__ import annotations

from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode
from rosbag2_py import TopicMetadata
from rosbag2_py.bag_writer import BagWriter, offered_qos
from rosbag2_py.last_messages import LastMessages
from rosbag2_py.selection import Selection
from rtps_graph.graph import Endpoint, Graph, Role

from ros2bag.qos_overrides import DEFAULT_DEPTH


class Recorder:
    """Subscribes to what is asked for, as it appears, and writes it down."""

    def __init__(
        self,
        node: CommandNode,
        writer: BagWriter,
        selection: Selection,
        overrides: dict[str, QoSProfile],
        *,
        is_paused: bool = False,
        last: LastMessages | None = None,
        include_unpublished: bool = False,
        ignore_leaves: bool = False,
    ) -> None:
        """
        Subscribe to nothing yet.

        :param last: what keeps messages until a snapshot is asked for; None to write each.
        :param include_unpublished: also to topics that are only subscribed to.
        :param ignore_leaves: not to topics before somebody else subscribes to them.
        """
        self.is_paused = is_paused  # what comes meanwhile is not written
        self._include_unpublished = include_unpublished
        self._ignore_leaves = ignore_leaves
        self._node = node
        self._writer = writer
        self._last = last
        self._selection = selection
        self._overrides = overrides
        self._seen: set[str] = set()

    def pause(self) -> None:
        self.is_paused = True
        self._log('Paused')

    def resume(self) -> None:
        self.is_paused = False
        self._log('Resumed')

    def toggle_paused(self) -> None:
        if self.is_paused:
            self.resume()
        else:
            self.pause()

    def split(self) -> None:
        """Go on in a new file."""
        self._writer.split()

    @property
    def takes_snapshots(self) -> bool:
        return self._last is not None

    def snapshot(self) -> bool:
        """Write the last messages; return whether that can be asked for."""
        if self._last is None:
            return False
        self._last.take()
        return True

    def missing(self) -> list[str]:
        """Return the topics that were named, those of services as well, and are not there."""
        return sorted({*self._selection.topics, *self._selection.services} - self._seen)

    @property
    def has_subscribed(self) -> bool:
        return bool(self._seen)

    def knows_new_topics(self) -> bool:
        """Return whether its node has come to know of topics that are wanted: a look for itself.

        To read the graph takes more time, and asks all others.
        """
        node = self._node.node
        return any(
            name not in self._seen
            and any(self._wants(name, each) for each in types)
            and (self._include_unpublished or node.count_publishers(name))
            and (not self._ignore_leaves or node.count_subscribers(name))
            for name, types in node.get_topic_names_and_types()
        )

    def subscribe_to_new_topics(self, graph: Graph) -> None:
        for name, types in graph.topics().items():
            if name in self._seen or not self._wants(name, types[0]):
                continue
            publishers = graph.with_role(Role.PUBLISHER, name)
            if not (publishers or self._include_unpublished):
                continue
            subscriptions = graph.with_role(Role.SUBSCRIPTION, name)
            if self._ignore_leaves and not subscriptions:
                continue
            self._seen.add(name)
            if len(types) > 1:
                self._log(f"Topic '{name}' has several types and is left out: {types}")
                continue
            type_hash = (publishers or subscriptions)[0].type_hash
            self._subscribe(name, types[0], type_hash, publishers)

    def _wants(self, name: str, type_name: str) -> bool:
        # Who names a hidden topic need not ask for all of them.
        is_named = name in self._selection.topics
        return self._selection.wants(name, type_name, also_hidden=is_named)

    def _subscribe(
        self, name: str, type_name: str, type_hash: str, publishers: list[Endpoint]
    ) -> None:
        try:
            message_class = interfaces.message(type_name)
        except CommandError as error:
            self._log(f"Topic '{name}' is left out: {error}")
            return
        reliable = all(p.qos.reliable for p in publishers)
        transient_local = bool(publishers) and all(p.qos.transient_local for p in publishers)
        offered = offered_qos(reliable=reliable, transient_local=transient_local)
        self._writer.add_topic(TopicMetadata(0, name, type_name, 'cdr', [offered], type_hash))
        qos = QoSProfile(depth=DEFAULT_DEPTH)
        if not reliable:
            qos.reliability = ReliabilityPolicy.BEST_EFFORT
        if transient_local:
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
        qos = self._overrides.get(name, qos)
        clock = self._node.node.get_clock()
        write = (self._last or self._writer).write

        def on_message(data: bytes, info: dict[str, Any]) -> None:
            if not self.is_paused:
                now_ns = clock.now().nanoseconds
                write(name, data, now_ns, info['source_timestamp'])

        self._node.node.create_subscription(message_class, name, on_message, qos, raw=True)
        self._log(f"Subscribed to topic '{name}'")

    def _log(self, text: str) -> None:
        self._node.node.get_logger().info(text)
