# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs of other packages use of `ros2 node`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from ros2cli import discovery
from ros2cli.helpers import wait_for
from rtps_graph.names import expand, full_node_name, is_hidden

INFO_NONUNIQUE_WARNING_TEMPLATE = (
    'WARNING: {num_nodes} nodes have the name {node_name}; this is about one of them'
)


class NodeName(NamedTuple):
    name: str
    namespace: str
    full_name: str


class TopicInfo(NamedTuple):
    name: str
    types: list[str]


def get_absolute_node_name(node_name: str | None) -> str | None:
    return expand(node_name) if node_name else None


def parse_node_name(node_name: str) -> NodeName:
    full_name = expand(node_name)
    namespace, _, name = full_name.rpartition('/')
    return NodeName(name, namespace or '/', full_name)


def has_duplicates(values: Sequence[Any]) -> bool:
    return len(set(values)) < len(values)


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[NodeName]:
    """List the nodes that `node` knows; hidden are those whose own name begins with '_'."""
    return [
        NodeName(name, namespace, full_node_name(namespace, name))
        for name, namespace, *_ in node.get_node_names_and_namespaces()
        if include_hidden_nodes or (name and not is_hidden(name))
    ]


def wait_for_node(
    node: Any,
    node_name: str,
    include_hidden_nodes: bool = False,
    timeout: float = 1.0,
) -> bool:
    """Wait until a node of this full name is there; False where `timeout` seconds passed."""

    def is_there() -> bool:
        found = get_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
        return any(each.full_name == node_name for each in found)

    return wait_for(is_there, timeout)


def get_topics(
    remote_node_name: str,
    func: Callable[[str, str], list[tuple[str, list[str]]]],
    *,
    include_hidden_topics: bool = False,
) -> list[TopicInfo]:
    """List what a function of name and namespace, as rclpy's nodes have it, tells of a node."""
    remote = parse_node_name(remote_node_name)
    return [
        TopicInfo(name, types)
        for name, types in func(remote.name, remote.namespace)
        if include_hidden_topics or not is_hidden(name)
    ]


def _teller(method: str) -> Callable[..., list[TopicInfo]]:
    def tell(*, node: Any, remote_node_name: str, include_hidden: bool = False) -> list[TopicInfo]:
        ask = getattr(node, method)
        return get_topics(remote_node_name, ask, include_hidden_topics=include_hidden)

    return tell


get_subscriber_info = _teller('get_subscriber_names_and_types_by_node')
get_publisher_info = _teller('get_publisher_names_and_types_by_node')
get_service_client_info = _teller('get_client_names_and_types_by_node')
get_service_server_info = _teller('get_service_names_and_types_by_node')
get_action_server_info = _teller('get_action_server_names_and_types_by_node')
get_action_client_info = _teller('get_action_client_names_and_types_by_node')


class NodeNameCompleter:
    """Offers the nodes that there are.

    :param include_hidden_nodes_key: where the arguments say whether hidden ones count too.
    """

    def __init__(self, *, include_hidden_nodes_key: str | None = None) -> None:
        self.include_hidden_nodes_key = include_hidden_nodes_key

    def __call__(self, prefix: str, parsed_args: argparse.Namespace, **_: Any) -> list[str]:
        hidden = getattr(parsed_args, self.include_hidden_nodes_key or '', False)
        nodes = discovery.read_graph(parsed_args, quiet=True).nodes
        return [node.full_name for node in nodes if hidden or not node.is_hidden]
