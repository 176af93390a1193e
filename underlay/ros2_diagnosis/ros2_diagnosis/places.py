# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes that this terminal does not see: in another domain, or on another machine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
import os
from pathlib import Path
import socket

from rtps_graph import graph, host, names
from rtps_graph.observer import Observer
from rtps_graph.participant import Participant
from rtps_graph.settings import LAST_DOMAIN, Settings

from ros2_diagnosis.finding import Finding

_LISTEN_SEC = 0.6
_DAEMON = f'{names.COMMAND_NODE}daemon_'
_LOOPBACK = '127.0.0.1'


def check_domains(settings: Settings, *, here: int) -> Iterator[Finding]:
    """Find ROS processes of this user on this machine in other domains.

    :param here: how many there are in this one; where there are some, the others are only noted.
    """
    others = {
        domain_id: number
        for domain_id, ports in _own_ports().items()
        if domain_id != settings.domain_id and (number := _count(domain_id, ports))
    }
    if others:
        total = sum(others.values())
        places = ', '.join(map(str, others))
        what = 'process of yours runs' if total == 1 else 'processes of yours run'
        yield Finding(
            f'domain {settings.domain_id}',
            f'{total} ROS {what} in domain {places} on this machine, which this terminal does '
            'not see',
            f'`export ROS_DOMAIN_ID={next(iter(others))}` joins it, in every terminal alike',
            serious=here == 0,
        )


def _own_ports() -> dict[int, set[int]]:
    """Return the discovery ports that may be of this user's participants, by their domains."""
    bound = host.bound_udp_ports(own=True) or set()
    found = {}
    for domain_id in range(LAST_DOMAIN + 1):
        if ports := host.participant_ports(domain_id, bound):
            found[domain_id] = ports
    return found


def _count(domain_id: int, ports: set[int]) -> int:
    """Count the participants at some ports that hold a node, but for daemons of `ros2`."""
    with Observer(domain_id=domain_id) as observer:
        observer.observe(timeout_sec=_LISTEN_SEC)
        return sum(
            any(not node.name.startswith(_DAEMON) for node in graph.build([participant]).nodes)
            for participant in observer.participants.values()
            if participant.discovery_port in ports
        )


def check_range(settings: Settings) -> Iterator[Finding]:
    """Find ROS processes on other machines, where the discovery range leaves them out."""
    if settings.discovery_range != 'LOCALHOST' or settings.static_peers:
        return
    with Observer(domain_id=settings.domain_id, subnet=True) as observer:
        observer.observe(timeout_sec=_LISTEN_SEC, settle_sec=_LISTEN_SEC)
        others = on_other_hosts(observer.participants.values(), own_addresses())
    if others:
        yield range_finding(settings, others)


def range_finding(settings: Settings, others: list[str]) -> Finding:
    return Finding(
        'ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST',
        f'{len(others)} ROS process{"" if len(others) == 1 else "es"} of domain '
        f'{settings.domain_id} on other machines ({", ".join(sorted(set(others)))}) cannot be '
        'reached from here',
        '`export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET` in every terminal, on both sides, if they '
        'belong to you',
        serious=False,
    )


def on_other_hosts(participants: Iterable[Participant], own: set[str]) -> list[str]:
    """List the addresses of the participants that are not on this machine."""
    return [p.address for p in participants if p.address not in own]


def own_addresses() -> set[str]:
    found = {_LOOPBACK}
    with contextlib.suppress(OSError):  # A host that cannot resolve its own name.
        found |= {str(info[4][0]) for info in socket.getaddrinfo(socket.gethostname(), None)}
    return found | set(_routed_addresses())


def _routed_addresses() -> Iterator[str]:
    """Yield the address of each route's interface: what the kernel would send from."""
    for target in (host.MULTICAST_ADDRESS, '192.0.2.1', '10.0.0.1', '192.168.0.1', '172.16.0.1'):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect((target, 9))
            except OSError:
                continue
            yield str(probe.getsockname()[0])


def check_environment(settings: Settings) -> Iterator[Finding]:
    """Find settings of this terminal with which ROS does not work as meant."""
    if not os.environ.get('AMENT_PREFIX_PATH'):
        yield Finding(
            'AMENT_PREFIX_PATH',
            'is empty, so that no package is found',
            'source a ROS 2 set-up file, or use `./lab shell`',
        )
    if settings.domain_id > LAST_DOMAIN:
        yield Finding(
            f'ROS_DOMAIN_ID={settings.domain_id}',
            'its ports are also given to other programs by Linux, so that nodes fail at random',
            f'`export ROS_DOMAIN_ID={settings.domain_id % LAST_DOMAIN}` (0 to {LAST_DOMAIN})',
        )
    if settings.discovery_range == 'OFF':
        yield Finding(
            'ROS_AUTOMATIC_DISCOVERY_RANGE=OFF',
            'no node finds another one',
            '`export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST`',
        )
    if server := os.environ.get('ROS_DISCOVERY_SERVER'):
        yield Finding(
            f'ROS_DISCOVERY_SERVER={server}',
            'nodes of this terminal are found by that server alone',
            '`unset ROS_DISCOVERY_SERVER`, unless it runs and all nodes are to use it',
            serious=False,
        )
    if why := _why_no_loopback():
        yield Finding(
            f'address {_LOOPBACK}',
            f'processes of this computer cannot meet there: {why}',
            'set the loopback interface up: `ip link set lo up`, as root',
        )
    for name in ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE'):
        path = os.environ.get(name)
        if path and not Path(path).is_file():
            yield Finding(name, f"names '{path}', which does not exist", f'`unset {name}`')


def _why_no_loopback() -> str:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own:
        try:
            own.bind((_LOOPBACK, 0))
            own.connect(own.getsockname())
        except OSError as error:
            return error.strerror or str(error)
    return ''
