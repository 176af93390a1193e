# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find out what a topic carries before subscribing to it."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
import re
import sys
import time
from typing import Any

from ros2_diagnosis import nearest, partners
from ros2cli import discovery, interfaces, interrupts
from ros2cli.errors import CommandError
from rtps_graph import names
from rtps_graph.graph import Endpoint, Graph, Role

_NAME = re.compile(r'/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*')

_POLL_SEC = 0.2


@dataclass(frozen=True)
class Topic:
    """A topic that exists."""

    name: str
    message_class: Any
    publishers: list[Endpoint]


def checked_name(topic: str) -> str:
    """Return the full name of a topic.

    :raises CommandError: it is no valid name.
    """
    if not _NAME.fullmatch(topic):
        raise CommandError(
            f"'{topic}' is no valid topic name: parts of letters, digits and _ that begin with "
            'no digit, separated by single /'
        )
    return names.expand(topic)


def find(
    args: argparse.Namespace, topic: str, *, type_name: str | None = None, wait: bool = False
) -> Topic:
    """Find a topic and the class of its messages.

    :param wait: wait for the topic instead of refusing one that does not exist yet.
    :raises CommandError: it is not there, or has no one type.
    """
    name = checked_name(topic)
    graph = discovery.read_graph(args)
    if type_name is None:
        if wait and name not in graph.topics():
            interrupts.heed_in_background()
            print(f'WARNING: topic [{name}] does not appear to be published yet')
            if why := why_unknown(graph, name):
                print(f"hint: nobody uses '{name}'{why}", file=sys.stderr)
            while name not in graph.topics():
                time.sleep(_POLL_SEC)
                graph = discovery.read_graph(args, quiet=True)
        type_name = _only_type(graph, topic, name)
    return Topic(name, interfaces.message(type_name), graph.with_role(Role.PUBLISHER, name))


def why_unknown(graph: Graph, name: str) -> str:
    """Return a clause for a message on a topic that is not there: what was meant, or is off."""
    if remedy := partners.how_to_switch_on(graph, name):
        return f'; that sensor of the simulator is off: {remedy}'
    return nearest.hint(name, graph.topics(), at_most=0)


def _only_type(graph: Graph, topic: str, name: str) -> str:
    topics = graph.topics()
    if name not in topics:
        raise CommandError(
            f'WARNING: topic [{topic}] does not appear to be published yet\n'
            f'Could not determine the type for the passed topic{why_unknown(graph, name)}'
        )
    types = topics[name]
    if len(types) > 1:
        raise CommandError(
            f"Cannot echo topic '{topic}', as it contains more than one type: "
            f'[{", ".join(types)}]; give the type behind the topic, or run `ros2 doctor`'
        )
    return types[0]
