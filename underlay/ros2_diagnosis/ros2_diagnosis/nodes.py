# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes that get in each other's way, wait for a clock, or do not answer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
import contextlib
import os

from rtps_graph import host, names
from rtps_graph.graph import Graph, Node, Role
from rtps_graph.settings import LAST_DOMAIN, settings_from_environment

from ros2_diagnosis.finding import Finding

_CLOCK = '/clock'
_TRANSFORMS = '/tf'
_PLAYER = 'rosbag2_player'
COMMAND = 'a `ros2` command'
SEND_GOAL = '/_action/send_goal'  # the service by which an action is known here
# Topics of which one robot has one publisher: two would contradict each other.
_SINGLE_PUBLISHER_ENDS = (
    'odometry/filtered',
    'ground_truth/odom',
    'husky_velocity_controller/odom',
    'cmd_vel',
)
# Every buffer of transforms that is given a node answers where its frames are.
_OFFERED_BY_MANY = ('tf2_msgs/srv/FrameGraph',)
# The first two bytes of a GUID (dds-foundation.org, "DDS-RTPS vendor and product IDs").
_VENDORS = {b'\x01\x01': 'Connext DDS', b'\x01\x0f': 'Fast DDS', b'\x01\x10': 'Cyclone DDS'}
_OWN_VENDOR = 'Fast DDS'  # of the wheels
_TOO_MANY = 10  # of the same in one node: a few broadcasters of transforms are usual
_RANGE_OFF = 'ROS_AUTOMATIC_DISCOVERY_RANGE=OFF'
_END_ONE = 'end one (Ctrl-C in its terminal), or give one its own ROS_DOMAIN_ID'


def check_names(graph: Graph) -> Iterator[Finding]:
    """Find nodes that share a name."""
    competing = {node.full_name for _, nodes in _competing_publishers(graph) for node in nodes}
    for name, number in Counter(node.full_name for node in graph.nodes).items():
        if number > 1:
            yield Finding(
                name,
                f'{number} nodes have this name, so that parameters and services reach only one '
                'of them',
                # Another name would not help those that publish the same.
                _END_ONE
                if name in competing
                else 'end one (Ctrl-C in its terminal), or start it with '
                f'`--ros-args -r __node:={name.rpartition("/")[2]}_2`',
            )


def check_publishers(graph: Graph) -> Iterator[Finding]:
    """Find nodes that publish what only one may; all topics of the same nodes in one line."""
    topics: dict[tuple[str, ...], list[str]] = {}
    for topic, nodes in _competing_publishers(graph):
        topics.setdefault(tuple(sorted(map(shown_name, nodes))), []).append(topic)
    for publishers, shared in topics.items():
        yield Finding(
            ', '.join(shared),
            f'{len(publishers)} nodes publish this: {", ".join(publishers)}, so that they '
            'contradict each other',
            _END_ONE,
        )


def check_servers(graph: Graph) -> Iterator[Finding]:
    """Find nodes that offer the same service or action; all of the same nodes in one line."""
    services: dict[tuple[str, ...], list[str]] = {}
    for service, types in graph.services().items():
        name, _, part = service.partition('/_action/')
        if part not in ('', 'send_goal') or any(kind in _OFFERED_BY_MANY for kind in types):
            continue
        found = map(graph.node_of, graph.with_role(Role.SERVER, service))
        nodes = list({id(node): node for node in found}.values())
        # What a node offers below its own name is told of with the name.
        if len(nodes) > 1 and not name.startswith(f'{nodes[0].full_name}/'):
            services.setdefault(tuple(sorted(map(shown_name, nodes))), []).append(name)
    for servers, shared in services.items():
        yield Finding(
            ', '.join(shared),
            f'{len(servers)} nodes offer this: {", ".join(servers)}, so that each carries out '
            'every call, and the first answer is taken',
            'end one (Ctrl-C in its terminal), or give one another namespace',
        )


def check_numbers(graph: Graph) -> Iterator[Finding]:
    """Find nodes that make the same again and again; all in one line for each."""
    for node in graph.nodes:
        found = Counter((each.name.removesuffix(SEND_GOAL), each.role) for each in node.endpoints)
        many = [
            f'{number} {role.value.lower()}s of {name}'
            for (name, role), number in found.items()
            if number >= _TOO_MANY and not names.is_hidden(name)
        ]
        if many:
            yield Finding(
                shown_name(node),
                f'has {", ".join(sorted(many))}, as one that makes another in each callback: all '
                'of them stay, and of the newest nobody knows yet when it is used',
                'make each once, in __init__, and use it again',
            )


def _competing_publishers(graph: Graph) -> Iterator[tuple[str, list[Node]]]:
    for topic in graph.topics():
        if topic == _CLOCK or topic.endswith(_SINGLE_PUBLISHER_ENDS):
            found = map(graph.node_of, graph.with_role(Role.PUBLISHER, topic))
            nodes = list({id(node): node for node in found}.values())  # two may look alike
            if len(nodes) > 1:
                yield topic, nodes


def shown_name(node: Node) -> str:
    is_command = node.full_name.startswith(f'/{names.COMMAND_NODE}')
    return COMMAND if is_command else node.full_name


def check_clock(graph: Graph) -> Iterator[Finding]:
    """Find nodes that use simulation time while nothing publishes the clock."""
    subscribers = map(graph.node_of, graph.with_role(Role.SUBSCRIPTION, _CLOCK))
    waiting = sorted({shown_name(node) for node in subscribers})
    if waiting and not graph.with_role(Role.PUBLISHER, _CLOCK):
        yield Finding(
            ', '.join(waiting),
            f'use_sim_time is true, but nobody publishes {_CLOCK}, so that its time stands still '
            'at 0 and its timers never fire',
            f'{_start_clock(graph)}, or {_without_clock(waiting[0])}',
        )


def check_wall_clock(graph: Graph) -> Iterator[Finding]:
    """Find nodes that hear transforms of simulated time, but go by the clock of the wall."""
    told = {id(graph.node_of(each)) for each in graph.with_role(Role.PUBLISHER, _CLOCK)}
    heeding = {id(graph.node_of(each)) for each in graph.with_role(Role.SUBSCRIPTION, _CLOCK)}
    hearing = map(graph.node_of, graph.with_role(Role.SUBSCRIPTION, _TRANSFORMS))
    found = sorted({shown_name(node) for node in hearing if id(node) not in told | heeding})
    if told and (found := [name for name in found if name != COMMAND]):
        yield Finding(
            ', '.join(found),
            f'use_sim_time is false, while {_TRANSFORMS} has the time of {_CLOCK}, so that '
            'transforms at get_clock().now() are never there',
            'start it with `--ros-args -p use_sim_time:=true`, or look up at `Time()`, the newest',
            serious=False,
        )


def _start_clock(graph: Graph) -> str:
    if any(node.name == _PLAYER for node in graph.nodes):
        return 'play the bag with --clock'
    return 'start the simulator'


def _without_clock(name: str) -> str:
    if name == COMMAND:
        return 'leave out --use-sim-time'
    return f'run `ros2 param set {name} use_sim_time false`'


def check_vendors(graph: Graph, service: str | None = None) -> Iterator[Finding]:
    """Find nodes on another DDS than this one; where a service is given, those that offer it."""
    others: dict[str, set[str]] = {}
    for endpoint in graph.endpoints:
        vendor = _VENDORS.get(endpoint.guid[:2], 'another DDS')
        offers = service is None or (endpoint.role, endpoint.name) == (Role.SERVER, service)
        if vendor != _OWN_VENDOR and offers:
            others.setdefault(vendor, set()).add(graph.node_of(endpoint).full_name)
    for vendor, found in others.items():
        yield Finding(
            ', '.join(sorted(found)),
            f'on {vendor}, and this terminal on {_OWN_VENDOR}: their topics meet, but services, '
            'parameters and actions never answer',
            'start all with the same RMW_IMPLEMENTATION (here rmw_fastrtps_cpp)',
        )


def check_memory(found: Iterable[Node]) -> Iterator[Finding]:
    """Find nodes of this machine that Fast DDS's shared memory keeps from those of this user."""
    by_owner: dict[str, set[str]] = {}
    for node in found:
        if node.foreign_memory is not None:
            by_owner.setdefault(node.foreign_memory.owner, set()).add(shown_name(node))
    for owner, apart in by_owner.items():
        if owner:
            what = f"of another user, '{owner}'"
            mend = (
                f'`export ROS_DOMAIN_ID={_own_domain()}` in your terminals keeps you apart, '
                '`export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET` joins you'
            )
        else:
            what = "its shared memory is not in this terminal's /dev/shm"
            mend = (
                'start it anew where somebody removed /dev/shm/fastrtps*, a container with '
                '`--ipc=host`'
            )
        yield Finding(', '.join(sorted(apart)), f'{what}: it is seen, but no message passes', mend)


def _own_domain() -> int:
    """Return a domain that few other users of this machine come to, and not this one."""
    domain_id = 1 + os.getuid() % LAST_DOMAIN
    return domain_id if domain_id != settings_from_environment().domain_id else domain_id - 1


def check_silent(graph: Graph, domain_id: int) -> Iterator[Finding]:
    """Find processes that are in the domain, but do not answer, or do not tell all they have."""
    for address in graph.silent_hosts:
        yield Finding(
            f'domain {domain_id}',
            f'a process of the host {address} announces itself and does not tell its nodes; what '
            'is shown may not be all',
            f'look on {address} for one that is stopped (Ctrl-Z), or a firewall that lets only '
            'multicast through',
        )
    for port in graph.silent_ports:
        if process := _undiscoverable(port):
            yield Finding(
                f'domain {domain_id}',
                f'process {process} was started with {_RANGE_OFF}, its nodes are not shown and '
                'get no messages',
                'start it again with `export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`',
            )
            continue
        yield Finding(
            f'domain {domain_id}',
            f'the process that listens at UDP port {port} does not answer, its nodes are not '
            '(or not all) shown and get no messages',
            f'it is stopped (Ctrl-Z) or hangs: `fg` continues it, `fuser -k {port}/udp` ends it',
        )


def _undiscoverable(port: int) -> str | None:
    """Return the number and name of the process at a port, where it lets itself not be found."""
    process = host.process_at(port)
    if process is None:
        return None
    with contextlib.suppress(OSError):  # it has ended
        if _RANGE_OFF.encode() in (process / 'environ').read_bytes().split(b'\0'):
            return f'{process.name} ({(process / "comm").read_text().strip()})'
    return None
