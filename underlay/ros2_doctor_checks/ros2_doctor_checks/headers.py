# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The headers of messages that somebody hears: a wrong time or frame is seen by nobody."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rclpy.qos import qos_profile_sensor_data
from ros2_diagnosis import nearest, nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode
from rtps_graph.graph import Graph, Role

_HEADER = 'std_msgs/Header'
# What says where something is: without a frame it says nothing.
_OF_PLACES = {
    *(f'sensor_msgs/msg/{name}' for name in ('LaserScan', 'PointCloud2', 'Range')),
    *(f'nav_msgs/msg/{name}' for name in ('Odometry', 'OccupancyGrid', 'Path')),
    *(f'geometry_msgs/msg/{name}Stamped' for name in ('Point', 'Pose', 'PoseWithCovariance')),
    'visualization_msgs/msg/Marker',
}


class Headers:
    """
    The first header of each topic that is published and subscribed to.

    :param first: by the name of the topic, as far as they have come.
    """

    def __init__(self, node: CommandNode, graph: Graph) -> None:
        self.first: dict[str, Any] = {}
        self._awaited = _stamped_topics(graph)
        for topic, kind in self._awaited.items():
            self._listen(node, topic, kind)

    @property
    def are_here(self) -> bool:
        """Whether no other is waited for."""
        return len(self.first) == len(self._awaited)

    def _listen(self, node: CommandNode, topic: str, kind: Any) -> None:
        def on_message(msg: Any) -> None:
            if topic not in self.first:
                self.first[topic] = msg.header
                # One is enough: pictures come in numbers that keep the rest waiting.
                node.node.destroy_subscription(subscription)

        subscription = node.node.create_subscription(
            kind, topic, on_message, qos_profile_sensor_data
        )


def check_frame_names(graph: Graph, headers: Headers, known: set[str]) -> Iterator[Finding]:
    """Find messages of no frame, or of one without a transform, where another is named alike."""
    for topic, header in sorted(headers.first.items()):
        frame = header.frame_id
        if not frame and _OF_PLACES.intersection(graph.topics()[topic]):
            yield Finding(
                topic,
                f'{publishers_of(graph, topic)} leaves header.frame_id empty, so that nobody can '
                'say where that is',
                'set it to the frame that it is told in',
                serious=False,
            )
        elif frame and frame not in known and (near := nearest.names(frame, known)):
            yield Finding(
                topic,
                f"{publishers_of(graph, topic)} names the frame '{frame}', of which there is no "
                'transform, so that nobody can say where that is',
                f'set header.frame_id to {" or ".join(map(repr, near))}, or publish a transform '
                'of that name',
                serious=False,
            )


def publishers_of(graph: Graph, topic: str) -> str:
    """Return the names of the nodes that publish a topic."""
    found = (graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, topic))
    return ', '.join(sorted({nodes.shown_name(node) for node in found}))


def _stamped_topics(graph: Graph) -> dict[str, Any]:
    """Return the class of each topic whose messages begin with a header, as far as it is known."""
    found = {}
    for topic, types in graph.topics().items():
        senders = [graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, topic)]
        if len(types) > 1 or not senders or not graph.with_role(Role.SUBSCRIPTION, topic):
            continue
        try:
            kind = interfaces.message(types[0])
        except CommandError:
            continue  # of a workspace that is not sourced here
        fields = kind.get_fields_and_field_types()
        if fields.get('header') == _HEADER and not any(nodes.check_memory(senders)):
            found[topic] = kind
    return found
