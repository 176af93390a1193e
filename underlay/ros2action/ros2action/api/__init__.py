# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs of other packages use of `ros2 action`."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli import completion
from rtps_graph.names import full_node_name

NamesAndTypes = list[tuple[str, list[str]]]


def get_action_clients_and_servers(
    *, node: Any, action_name: str
) -> tuple[NamesAndTypes, NamesAndTypes]:
    """List the nodes that have clients of an action, and those that have servers, with the types.

    :raises ValueError: the name is invalid.
    :raises InvalidTopicNameException: the name is invalid (rclpy's).
    """
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name

    full_name = expand_topic_name(action_name, node.get_name(), node.get_namespace())
    validate_full_topic_name(full_name)
    clients: NamesAndTypes = []
    servers: NamesAndTypes = []
    for name, namespace in node.get_node_names_and_namespaces():
        for found, ask in (
            (clients, node.get_action_client_names_and_types_by_node),
            (servers, node.get_action_server_names_and_types_by_node),
        ):
            types = dict(ask(name, namespace)).get(full_name)
            if types is not None:
                found.append((full_node_name(namespace, name), types))
    return clients, servers


def get_action_names_and_types(*, node: Any) -> NamesAndTypes:
    return list(node.get_action_names_and_types())


def get_action_names(*, node: Any) -> list[str]:
    return [name for name, _ in get_action_names_and_types(node=node)]


def action_name_completer(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    return completion.NameCompleter('action')(prefix, parsed_args)


def action_type_completer(**_: Any) -> list[str]:
    return completion.known_types('action')


class ActionTypeCompleter(completion.TypeCompleter):
    def __init__(self, *, action_name_key: str | None = None) -> None:
        super().__init__('action', action_name_key)


class ActionGoalPrototypeCompleter(completion.PrototypeCompleter):
    def __init__(self, *, action_type_key: str | None = None) -> None:
        super().__init__(action_type_key)
