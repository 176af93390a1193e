# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the graph as the environment asks for it: domain, range, peers."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable
import sys
import threading

from rtps_graph import graph, names
from rtps_graph import settings as rtps_settings
from rtps_graph.observer import Observer

from ros2cli.errors import UsageError

DEFAULT_TIMEOUT_SEC = 8.0  # all have answered long before, but on a machine that stands still
DEFAULT_SPIN_TIME_SEC = 0.5
SOON_SEC = 1.0  # a service that answers at all mostly answers sooner


# Of nodes: raise KeyboardInterrupt where a signal has come that Python is not told of.
signal_checks: list[Callable[[], None]] = []


def settings_from_environment() -> rtps_settings.Settings:
    """Read ROS_DOMAIN_ID and its companions.

    :raises UsageError: a variable holds what ROS 2 does not know.
    """
    try:
        return rtps_settings.settings_from_environment()
    except ValueError as error:
        raise UsageError(str(error)) from None


def add_direct_arguments(parser: argparse.ArgumentParser) -> None:
    """Add upstream's options of a verb that has a node of its own."""
    parser.add_argument(
        '--spin-time',
        type=float,
        default=DEFAULT_SPIN_TIME_SEC,
        help='Spin time in seconds to wait for discovery of other hosts; the nodes of this host '
        'are counted, so that nothing has to be waited for',
    )
    parser.add_argument(
        '-s', '--use-sim-time', action='store_true', help='Enable ROS simulation time'
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add upstream's options of a verb that looks at the graph."""
    add_direct_arguments(parser)
    parser.add_argument(
        '--no-daemon',
        action='store_true',
        help='Do not use the daemon, which only verbs of other packages do here',
    )


def read_graph(args: argparse.Namespace | None = None, *, quiet: bool = False) -> graph.Graph:
    """Read the graph of the domain; unless `quiet`, hints on stderr where it is empty."""
    settings = settings_from_environment()
    if settings.discovery_range == 'OFF':
        if not quiet:
            print(
                'hint: ROS_AUTOMATIC_DISCOVERY_RANGE=OFF, so that nothing is discovered; '
                '`export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST` shows the nodes of this machine',
                file=sys.stderr,
            )
        return graph.Graph([], [])
    settle_sec = max(0.0, getattr(args, 'spin_time', DEFAULT_SPIN_TIME_SEC))
    with Observer(
        domain_id=settings.domain_id,
        subnet=settings.discovery_range != 'LOCALHOST',
        static_peers=settings.static_peers,
    ) as observer:
        observer.observe(
            timeout_sec=max(DEFAULT_TIMEOUT_SEC, settle_sec + 1.0),
            settle_sec=settle_sec,
            check=_check_signals,
        )
        found = graph.build(
            observer.participants.values(), observer.unanswered, observer.silent_hosts
        )
    if not quiet:
        _print_hints(settings, found)
    return found


def by_kind(found: graph.Graph, kind: str, *, hidden: bool = True) -> dict[str, list[str]]:
    """Map the names of topics, services or actions (`kind`) to their types."""
    read = {'topic': found.topics, 'service': found.services, 'action': found.actions}[kind]
    return {name: types for name, types in read().items() if hidden or not names.is_hidden(name)}


def near(name: str, known: Iterable[str]) -> str:
    """Return a clause with the nearest names for a message; nothing where none is near."""
    from ros2_diagnosis import nearest

    return nearest.hint(names.expand(name), known, at_most=0)


def hint_near(message: str, name: str, known: Iterable[str]) -> None:
    """Print a message as a hint where a name is near to one that is known."""
    if clause := near(name, known):
        print(f'hint: {message}{clause}', file=sys.stderr)


def hint_when_not_offered(service: str) -> None:
    """Print why a client finds no server: it has another type, or another name.

    :param service: of an action, that which sends goals.
    """
    from ros2_diagnosis import connections, nodes

    found = read_graph(quiet=True)
    for finding in connections.check_service_types(found, service):
        print(f'hint: {finding}', file=sys.stderr)
    servers = {each.name for each in found.endpoints if each.role is graph.Role.SERVER}
    if service not in servers:
        end = nodes.SEND_GOAL if service.endswith(nodes.SEND_GOAL) else ''
        name = service.removesuffix(end)
        offered = {each.removesuffix(end) for each in servers if each.endswith(end)}
        hint_near(f"nobody offers '{name}'", name, offered)


def why_unanswered(services: Iterable[str]) -> dict[str, str]:
    """Return for each service that is there and will never answer, why."""
    from ros2_diagnosis import nodes

    read = read_graph(quiet=True)
    why: dict[str, str] = {}
    for service in services:
        servers = map(read.node_of, read.with_role(graph.Role.SERVER, service))
        for finding in (*nodes.check_vendors(read, service), *nodes.check_memory(servers)):
            why[service] = str(finding)
    return why


def _check_signals() -> None:
    if threading.current_thread() is threading.main_thread():  # the one that signals interrupt
        for check in signal_checks:
            check()


def _print_hints(settings: rtps_settings.Settings, found: graph.Graph) -> None:
    from ros2_diagnosis import nodes, places

    findings = list(nodes.check_silent(found, settings.domain_id))
    if not found.nodes:
        # The nodes may run in another domain.
        findings += places.check_domains(settings, here=0)
    for finding in findings:
        print(f'hint: {finding}', file=sys.stderr)
