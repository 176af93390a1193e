# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms that no listener can use: of another time than the others, or of two parents."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
import itertools
import time
from typing import Any

from rclpy.qos import qos_profile_sensor_data
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.node.direct import command_node, CommandNode
from rtps_graph.graph import Graph, Role

_TRANSFORMS, _CLOCK = '/tf', '/clock'
_FIRST_SEC, _LISTEN_SEC = 2.0, 1.0
_APART_SEC = 60.0  # no transform is sent so late, or so far ahead
_BEGINNING_SEC = 1.0  # of a simulation, in which a stamp of 0 may be right
_SHOWN = 3


@dataclass
class _Heard:
    """What comes on /tf while it is listened to.

    :param times: those that the clock has told meanwhile, in seconds.
    :param links: the parent and the stamp of each transform, by its child.
    """

    times: list[float] = field(default_factory=list)
    links: dict[str, list[tuple[str, float]]] = field(default_factory=dict)

    def on_clock(self, msg: Any) -> None:
        self.times.append(_seconds(msg.clock))

    def on_transforms(self, msg: Any) -> None:
        for each in msg.transforms:
            link = each.header.frame_id, _seconds(each.header.stamp)
            self.links.setdefault(each.child_frame_id, []).append(link)

    def is_timely(self, stamp: float) -> bool:
        first, last = min(self.times), max(self.times)
        if stamp == 0.0:
            return first < _BEGINNING_SEC
        apart = _APART_SEC + last - first  # simulated time may pass a hundred times as fast
        return first - apart < stamp < last + apart


def check_frames(graph: Graph) -> Iterator[Finding]:
    """Listen to the transforms, where there are some that can be heard here."""
    publishers = [graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, _TRANSFORMS)]
    if not publishers or any(nodes.check_memory(publishers)):
        return
    has_clock = bool(graph.with_role(Role.PUBLISHER, _CLOCK))
    with command_node() as node:
        heard = _listen(node, has_clock=has_clock)
    publishing = sorted({nodes.shown_name(each) for each in publishers})
    yield from _two_parents(heard, ', '.join(publishing))
    # Where nodes wait for a clock, that is told, and all follows from it.
    waits = not has_clock and bool(graph.with_role(Role.SUBSCRIPTION, _CLOCK))
    if heard.times and not waits:
        clock = _CLOCK if has_clock else 'the clock of this computer'
        yield from _of_another_time(graph, heard, clock)


def _listen(node: CommandNode, *, has_clock: bool) -> _Heard:
    heard = _Heard()
    kind = interfaces.message('tf2_msgs/msg/TFMessage')
    if has_clock:
        clock = interfaces.message('rosgraph_msgs/msg/Clock')
        node.node.create_subscription(clock, _CLOCK, heard.on_clock, qos_profile_sensor_data)
        node.spin_until(lambda: bool(heard.times), _FIRST_SEC)
    else:
        heard.times.append(time.time())
    node.node.create_subscription(kind, _TRANSFORMS, heard.on_transforms, qos_profile_sensor_data)
    if node.spin_until(lambda: bool(heard.links), _FIRST_SEC):
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
    told = {id(graph.node_of(each)) for each in graph.with_role(Role.PUBLISHER, _CLOCK)}
    heeding = {id(graph.node_of(each)) for each in graph.with_role(Role.SUBSCRIPTION, _CLOCK)}
    publishers = list(map(graph.node_of, graph.with_role(Role.PUBLISHER, _TRANSFORMS)))
    others = [node for node in publishers if id(node) not in told | heeding]
    by = ', '.join(sorted({nodes.shown_name(node) for node in others or publishers}))
    stamp = max(apart.values())
    if stamp == 0.0 or (not others and clock == _CLOCK):
        mend = 'set header.stamp'
    elif clock == _CLOCK:
        mend = f'start {by} with `--ros-args -p use_sim_time:=true`, and set header.stamp'
    else:
        mend = 'play a bag with --clock and use_sim_time in the others, or set header.stamp'
    yield Finding(
        f'frame {", ".join(sorted(apart)[:_SHOWN])}',
        f'stamped by {by} with {stamp:.0f} s, while {clock} tells {heard.times[-1]:.0f} s, so '
        'that lookups fail by extrapolation',
        f'{mend} to `get_clock().now().to_msg()`',
        serious=bool(frames[True] & frames[False]),
    )


def _seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec * 1e-9)
