# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Choose what of a ROS graph is drawn: nodes, topics, and who gives what to whom."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
import enum

from ros2_diagnosis import connections
from rtps_graph import names
from rtps_graph.graph import Graph, Role

# Names that rqt_graph calls debug: they are in every graph and say nothing about this one.
DEBUG_TOPICS = frozenset(
    {'/clock', '/parameter_events', '/rosout', '/rosout_agg', '/statistics', '/time'}
)
DEBUG_NODES = ('/cpu_monitor', '/diag_agg', '/hd_monitor', '/monitor', '/rqt', '/runtime_logger')


class View(enum.Enum):
    """Which topics are drawn, under the names that rqt_graph gives the choices."""

    ACTIVE = 'active'  # those with a publisher and a subscription
    ALL = 'all'


class Kind(enum.Enum):
    NODE = 'node'
    TOPIC = 'topic'


@dataclass(frozen=True)
class Shape:
    """A node, drawn as an ellipse, or a topic, drawn as a box."""

    kind: Kind
    name: str
    note: str  # more about it, a line a fact
    faulty: bool = False

    @property
    def key(self) -> str:
        return f'{self.kind.value}:{self.name}'

    @property
    def namespace(self) -> str:
        """Return its outermost namespace, '' for none."""
        first, _, rest = self.name.removeprefix('/').partition('/')
        return '/' + first if rest else ''


@dataclass(frozen=True)
class Arrow:
    start: str  # keys of shapes
    end: str


@dataclass(frozen=True)
class Drawing:
    """All that is drawn, in a fixed order: equal graphs give equal drawings."""

    shapes: tuple[Shape, ...]
    arrows: tuple[Arrow, ...]

    def count(self, kind: Kind) -> int:
        return sum(shape.kind is kind for shape in self.shapes)


def select(graph: Graph, view: View = View.ACTIVE, *, debug: bool = False) -> Drawing:
    """Choose what is drawn.

    :param debug: draw the names too that every graph has, such as /rosout and /clock.
    """
    nodes = Counter(n.full_name for n in graph.nodes if debug or not _is_debug_node(n.full_name))
    publishing, subscribing = _connections(graph, set(nodes), debug=debug)
    topics = (
        set(publishing) & set(subscribing)
        if view is View.ACTIVE
        else set(publishing) | set(subscribing)
    )
    faults = {finding.where: str(finding) for finding in connections.check(graph)}
    types = graph.topics()
    shapes = [_node(name, count) for name, count in sorted(nodes.items())]
    shapes += [_topic(name, types.get(name, []), faults.get(name)) for name in sorted(topics)]
    arrows = [
        Arrow(f'node:{node}', f'topic:{topic}')
        for topic in sorted(topics)
        for node in sorted(publishing.get(topic, ()))
    ]
    arrows += [
        Arrow(f'topic:{topic}', f'node:{node}')
        for topic in sorted(topics)
        for node in sorted(subscribing.get(topic, ()))
    ]
    return Drawing(tuple(shapes), tuple(arrows))


def _connections(
    graph: Graph, nodes: set[str], *, debug: bool
) -> tuple[dict[str, set[str]], dict[str, set[str]]]:
    """Return the publishing and the subscribing nodes of each topic."""
    publishing: dict[str, set[str]] = {}
    subscribing: dict[str, set[str]] = {}
    for node in graph.nodes:
        if node.full_name not in nodes:
            continue
        for role, found in ((Role.PUBLISHER, publishing), (Role.SUBSCRIPTION, subscribing)):
            for topic in node.having(role):
                if debug or not _is_debug_topic(topic):
                    found.setdefault(topic, set()).add(node.full_name)
    return publishing, subscribing


def _is_debug_topic(name: str) -> bool:
    return name in DEBUG_TOPICS or names.is_hidden(name)


def _is_debug_node(name: str) -> bool:
    return names.is_hidden(name) or name.startswith(DEBUG_NODES)


def _node(name: str, count: int) -> Shape:
    note = name
    if count > 1:
        note += f'\n{count} nodes have this name: give each its own'
    return Shape(Kind.NODE, name, note, faulty=count > 1)


def _topic(name: str, types: list[str], fault: str | None) -> Shape:
    note = '\n'.join([name, *types, *filter(None, [fault])])
    return Shape(Kind.TOPIC, name, note, faulty=fault is not None)
