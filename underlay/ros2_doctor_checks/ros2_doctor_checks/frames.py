# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms and headers that no listener can use: of another time or frame than the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
import itertools
import time
from typing import Any

from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.node.direct import command_node, CommandNode
from rtps_graph.graph import Graph, Role

from ros2_doctor_checks.headers import check_frame_names, Headers

_TRANSFORMS, _FIXED, _CLOCK = '/tf', '/tf_static', '/clock'
_KEPT = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FIRST_SEC, _LISTEN_SEC = 2.0, 1.0
_APART_SEC = 60.0  # no transform is sent so late, or so far ahead
_BEGINNING_SEC = 1.0  # of a simulation, in which a stamp of 0 may be right
_SHOWN = 3


@dataclass
class _Heard:
    """What comes while it is listened to.

    :param times: those that the clock has told meanwhile, in seconds.
    :param links: the parent and the stamp of each transform on /tf, by its child.
    :param fixed: the frames of /tf_static.
    """

    times: list[float] = field(default_factory=list)
    links: dict[str, list[tuple[str, float]]] = field(default_factory=dict)
    fixed: set[str] = field(default_factory=set)

    def on_clock(self, msg: Any) -> None:
        self.times.append(_seconds(msg.clock))

    def on_transforms(self, msg: Any) -> None:
        for each in msg.transforms:
            link = each.header.frame_id, _seconds(each.header.stamp)
            self.links.setdefault(each.child_frame_id, []).append(link)

    def on_fixed(self, msg: Any) -> None:
        for each in msg.transforms:
            self.fixed |= {each.header.frame_id, each.child_frame_id}

    def is_timely(self, stamp: float) -> bool:
        first, last = min(self.times), max(self.times)
        if stamp == 0.0:
            return first < _BEGINNING_SEC
        apart = _APART_SEC + last - first  # simulated time may pass a hundred times as fast
        return first - apart < stamp < last + apart

    def frames(self) -> set[str]:
        parents = {parent for links in self.links.values() for parent, _ in links}
        return self.fixed | parents | self.links.keys()


def check_frames(graph: Graph) -> Iterator[Finding]:
    """Listen to the transforms and headers, where there are some that can be heard here."""
    publishers = [graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, _TRANSFORMS)]
    if any(nodes.check_memory(publishers)):
        return
    has_clock = bool(graph.with_role(Role.PUBLISHER, _CLOCK))
    if not publishers and not has_clock:
        return
    with command_node() as node:
        headers = Headers(node, graph)
        heard = _listen(node, headers, has_clock=has_clock, has_transforms=bool(publishers))
    publishing = sorted({nodes.shown_name(each) for each in publishers})
    yield from _two_parents(heard, ', '.join(publishing))
    yield from check_frame_names(graph, headers, heard.frames())
    # Where nodes wait for a clock, that is told, and all follows from it.
    waits = not has_clock and bool(graph.with_role(Role.SUBSCRIPTION, _CLOCK))
    if heard.times and not waits:
        clock = _CLOCK if has_clock else 'the clock of this computer'
        yield from _of_another_time(graph, heard, clock)
        yield from _headers_of_another_time(graph, headers, heard, clock)


def _listen(
    node: CommandNode, headers: Headers, *, has_clock: bool, has_transforms: bool
) -> _Heard:
    heard = _Heard()
    kind = interfaces.message('tf2_msgs/msg/TFMessage')
    if has_clock:
        clock = interfaces.message('rosgraph_msgs/msg/Clock')
        node.node.create_subscription(clock, _CLOCK, heard.on_clock, qos_profile_sensor_data)
        node.spin_until(lambda: bool(heard.times), _FIRST_SEC)
    else:
        heard.times.append(time.time())
    node.node.create_subscription(kind, _TRANSFORMS, heard.on_transforms, qos_profile_sensor_data)
    node.node.create_subscription(kind, _FIXED, heard.on_fixed, _KEPT)
    if not has_transforms:
        node.spin_until(lambda: headers.are_here, _LISTEN_SEC)
    elif node.spin_until(lambda: bool(heard.links), _FIRST_SEC):
        node.spin_until(lambda: False, _LISTEN_SEC)
    return heard


def _two_parents(heard: _Heard, publishing: str) -> Iterator[Finding]:
    for child, links in sorted(heard.links.items()):
        parents = [parent for parent, _ in links]
        # One that is handed over, as a cup from the table to the hand, changes once.
        if sum(a != b for a, b in itertools.pairwise(parents)) > 1:
            shown = ' and '.join(sorted(set(parents)))
            yield Finding(
                f'frame {child}',
                f'has several parents, {shown}, so that it jumps between them',
                f'let one node alone publish it, below one parent; on {_TRANSFORMS} publish '
                f'{publishing}',
            )


def _of_another_time(graph: Graph, heard: _Heard, clock: str) -> Iterator[Finding]:
    """Find transforms that are never found together with others.

    They are no fault where they are a tree of their own.
    """
    apart: dict[str, float] = {}
    frames: dict[bool, set[str]] = {True: set(), False: set()}
    for child, links in heard.links.items():
        for parent, stamp in links:
            is_timely = heard.is_timely(stamp)
            frames[is_timely] |= {child, parent}
            if not is_timely:
                apart[child] = stamp
    if not apart:
        return
    stamp = max(apart.values())
    by, mend = _blame(graph, _TRANSFORMS, stamp, clock)
    yield Finding(
        f'frame {", ".join(sorted(apart)[:_SHOWN])}',
        f'stamped by {by} with {stamp:.0f} s, while {clock} tells {heard.times[-1]:.0f} s, so '
        'that lookups fail by extrapolation',
        mend,
        serious=bool(frames[True] & frames[False]),
    )


def _headers_of_another_time(
    graph: Graph, headers: Headers, heard: _Heard, clock: str
) -> Iterator[Finding]:
    """Find messages that are never put together with others; those without a stamp say so."""
    for topic, header in sorted(headers.first.items()):
        stamp = _seconds(header.stamp)
        if stamp != 0.0 and not heard.is_timely(stamp):
            by, mend = _blame(graph, topic, stamp, clock)
            yield Finding(
                topic,
                f'stamped by {by} with {stamp:.0f} s, while {clock} tells {heard.times[-1]:.0f} '
                's, so that message_filters and tf2 find nothing that goes with it',
                mend,
                serious=clock == _CLOCK,
            )


def _blame(graph: Graph, topic: str, stamp: float, clock: str) -> tuple[str, str]:
    """Return who publishes a topic by another clock, and what to do."""
    told = {id(graph.node_of(each)) for each in graph.with_role(Role.PUBLISHER, _CLOCK)}
    heeding = {id(graph.node_of(each)) for each in graph.with_role(Role.SUBSCRIPTION, _CLOCK)}
    publishers = list(map(graph.node_of, graph.with_role(Role.PUBLISHER, topic)))
    others = [node for node in publishers if id(node) not in told | heeding]
    by = ', '.join(sorted({nodes.shown_name(node) for node in others or publishers}))
    if stamp == 0.0 or (not others and clock == _CLOCK):
        mend = 'set header.stamp'
    elif clock == _CLOCK:
        mend = f'start {by} with `--ros-args -p use_sim_time:=true`, and set header.stamp'
    else:
        mend = 'play a bag with --clock and use_sim_time in the others, or set header.stamp'
    return by, f'{mend} to `get_clock().now().to_msg()`'


def _seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec * 1e-9)
