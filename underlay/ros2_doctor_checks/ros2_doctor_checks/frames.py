# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Transforms and headers that no listener can use: of another time or frame than the others."""

from __future__ import annotations

from collections.abc import Iterator
import time

from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, QoSProfile
from ros2_diagnosis import nodes
from ros2_diagnosis.finding import Finding
from ros2cli import interfaces
from ros2cli.node.direct import command_node, CommandNode
from rtps_graph.graph import Graph, Role

from ros2_doctor_checks.headers import check_frame_names, Headers, publishers_of
from ros2_doctor_checks.transforms import (
    check_refused,
    check_roots,
    check_senders,
    FIXED,
    Heard,
    seconds,
    TRANSFORMS,
)

_CLOCK = '/clock'
_KEPT = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FIRST_SEC, _LISTEN_SEC = 5.0, 1.0  # DDS repeats after 3 s what got lost of a new subscription
_SHOWN = 3


def check_frames(graph: Graph) -> Iterator[Finding]:
    """Listen to the transforms and headers, where there are some that can be heard here."""
    publishers = [graph.node_of(each) for each in graph.with_role(Role.PUBLISHER, TRANSFORMS)]
    if any(nodes.check_memory(publishers)):
        return
    has_clock = bool(graph.with_role(Role.PUBLISHER, _CLOCK))
    of_fixed = graph.with_role(Role.PUBLISHER, FIXED)
    if not publishers and not has_clock and len(of_fixed) < 2:
        return
    with command_node() as node:
        headers = Headers(node, graph)
        heard = _listen(
            node,
            headers,
            has_clock=has_clock,
            has_moving=bool(publishers),
            has_fixed=bool(of_fixed),
        )
    moving, fixed = (publishers_of(graph, topic) for topic in (TRANSFORMS, FIXED))
    yield from check_refused(heard, ', '.join(filter(None, (moving, fixed))))
    yield from check_senders(heard, moving, fixed)
    yield from check_roots(heard)
    yield from check_frame_names(graph, headers, heard.frames())
    # Where nodes wait for a clock, that is told, and all follows from it.
    waits = not has_clock and bool(graph.with_role(Role.SUBSCRIPTION, _CLOCK))
    if heard.times and not waits:
        clock = _CLOCK if has_clock else 'the clock of this computer'
        yield from _of_another_time(graph, heard, clock)
        yield from _headers_of_another_time(graph, headers, heard, clock)


def _listen(
    node: CommandNode, headers: Headers, *, has_clock: bool, has_moving: bool, has_fixed: bool
) -> Heard:
    """Listen for a while, which begins when something has come of all that somebody publishes."""
    heard = Heard()
    kind = interfaces.message('tf2_msgs/msg/TFMessage')
    if has_clock:
        clock = interfaces.message('rosgraph_msgs/msg/Clock')
        node.node.create_subscription(clock, _CLOCK, heard.on_clock, qos_profile_sensor_data)
        node.spin_until(lambda: bool(heard.times), _FIRST_SEC)
    else:
        heard.times.append(time.time())
    node.node.create_subscription(kind, TRANSFORMS, heard.on_transforms, qos_profile_sensor_data)
    node.node.create_subscription(kind, FIXED, heard.on_fixed, _KEPT)

    def has_come() -> bool:
        return bool(heard.links or not has_moving) and bool(heard.fixed or not has_fixed)

    if not has_moving and not has_fixed:
        node.spin_until(lambda: headers.are_here, _LISTEN_SEC)
    elif node.spin_until(has_come, _FIRST_SEC):
        node.spin_until(lambda: False, _LISTEN_SEC)
    return heard


def _of_another_time(graph: Graph, heard: Heard, clock: str) -> Iterator[Finding]:
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
    by, mend = _blame(graph, TRANSFORMS, stamp, clock)
    yield Finding(
        f'frame {", ".join(sorted(apart)[:_SHOWN])}',
        f'stamped by {by} with {stamp:.0f} s, while {clock} tells {heard.times[-1]:.0f} s, so '
        'that lookups fail by extrapolation',
        mend,
        serious=bool(frames[True] & frames[False]),
    )


def _headers_of_another_time(
    graph: Graph, headers: Headers, heard: Heard, clock: str
) -> Iterator[Finding]:
    """Find messages that are never put together with others; those without a stamp say so."""
    for topic, header in sorted(headers.first.items()):
        stamp = seconds(header.stamp)
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
