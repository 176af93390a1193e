# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask services again what a bag holds that they were asked."""

from __future__ import annotations

import argparse
from typing import Any

from rclpy.serialization import deserialize_message
from ros2cli import arguments, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode
import rosbag2_py
from rosbag2_py.selection import EVENTS
from rtps_graph import names
from service_msgs.msg import ServiceEventInfo

_READY_TIMEOUT_SEC = 2.0
_ANSWER_TIMEOUT_SEC = 2.0
_SOURCES = {
    'service_introspection': ServiceEventInfo.REQUEST_RECEIVED,
    'client_introspection': ServiceEventInfo.REQUEST_SENT,
}


class RequestPlayer:
    """Takes the events of a service as a publisher would; sends the requests in them."""

    def __init__(self, node: CommandNode, service: str, service_class: Any, event: int) -> None:
        self._node = node.node
        self._service = service
        self._class = service_class
        self._event = event
        self._client = node.node.create_client(service_class, service)
        self._futures: list[Any] = []
        self._said: set[str] = set()

    @property
    def is_ready(self) -> bool:
        return bool(self._client.service_is_ready())

    @property
    def is_answered(self) -> bool:
        return all(future.done() for future in self._futures)

    def publish(self, data: bytes) -> bool:
        """Send the request in an event; False where it has none to send."""
        event = deserialize_message(data, self._class.Event)
        if event.info.event_type != self._event:
            return False
        if not event.request:
            self._warn_once('the bag has only metadata of its calls: record with `contents`')
            return False
        if not self.is_ready:
            self._warn_once('a request is not sent, the service is not there')
            return False
        self._futures = [future for future in self._futures if not future.done()]
        self._futures.append(self._client.call_async(event.request[0]))
        return True

    def _warn_once(self, text: str) -> None:
        if text not in self._said:
            self._said.add(text)
            self._node.get_logger().warning(f"Service '{self._service}': {text}")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_flags(
        parser,
        {'--publish-service-requests': 'Send recorded requests to the services again, '
         'in place of the events of the services.'},
    )  # fmt: skip
    parser.add_argument(
        '--service-requests-source',
        choices=list(_SOURCES),
        default='service_introspection',
        help='Whose record of the requests is sent: that of the services or that of the clients.',
    )


def players_of(
    node: CommandNode,
    args: argparse.Namespace,
    topics: list[rosbag2_py.TopicMetadata],
    remaps: dict[str, str],
) -> dict[str, RequestPlayer]:
    """
    Return one for each service in the bag, ready where the service runs; {} if not wanted.

    Services whose type is not installed are left out.
    """
    if not args.publish_service_requests:
        return {}
    players = {}
    for topic in topics:
        if topic.name.endswith(EVENTS) and topic.type.endswith('_Event'):
            service = names.expand(topic.name.removesuffix(EVENTS))
            try:
                service_class = interfaces.service(topic.type.removesuffix('_Event'))
            except CommandError:
                continue  # nor can its events be published, of which it is said
            event = _SOURCES[args.service_requests_source]
            name = remaps.get(service, service)
            players[topic.name] = RequestPlayer(node, name, service_class, event)
    node.spin_until(lambda: all(player.is_ready for player in players.values()),
                    _READY_TIMEOUT_SEC if players else 0.0)  # fmt: skip
    return players


def wait_for_answers(node: CommandNode, players: dict[str, RequestPlayer]) -> None:
    """Stay until the services have answered, or for 2 s: who answers finds somebody there."""
    node.spin_until(lambda: all(p.is_answered for p in players.values()), _ANSWER_TIMEOUT_SEC)
