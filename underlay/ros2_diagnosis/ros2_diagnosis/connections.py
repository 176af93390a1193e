# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers and subscriptions of one topic, servers and clients of one service, kept apart."""

from __future__ import annotations

from collections.abc import Iterator

from rtps_graph.graph import Endpoint, Graph, Qos, Role

from ros2_diagnosis.finding import Finding
from ros2_diagnosis.nodes import SEND_GOAL, shown_name


def check(graph: Graph, topic: str | None = None) -> Iterator[Finding]:
    """Find all that keeps publishers and subscriptions apart."""
    yield from check_types(graph, topic)
    yield from check_qos(graph, topic)


def check_types(graph: Graph, topic: str | None = None) -> Iterator[Finding]:
    """Find topics whose publishers and subscriptions have different types, or definitions."""
    for name, types in graph.topics().items():
        if topic not in (None, name):
            continue
        publishers = graph.with_role(Role.PUBLISHER, name)
        subscriptions = graph.with_role(Role.SUBSCRIPTION, name)
        for publisher, subscription in _pairs(publishers, subscriptions):
            if publisher.type != subscription.type:
                yield Finding(
                    name,
                    f'{_node(graph, publisher)} publishes {publisher.type}, but '
                    f'{_node(graph, subscription)} subscribes to {subscription.type}, so that '
                    'nothing arrives',
                    f'use one type in both, or another topic name '
                    f'(`ros2 topic info -v {name}` shows them)',
                )
            elif _defined_differently(publisher, subscription):
                yield _two_definitions(graph, name, publisher, subscription)
        if len(types) > 1 and not (publishers and subscriptions):
            yield Finding(
                name,
                f'has several types: {", ".join(types)}',
                'give the topics different names, or use one type',
            )


def check_service_types(graph: Graph, service: str | None = None) -> Iterator[Finding]:
    """Find services whose servers and clients have different types, or definitions.

    That which sends goals is shown as the action.
    """
    for name in graph.services():
        if service not in (None, name):
            continue
        servers = graph.with_role(Role.SERVER, name)
        for server, client in _pairs(servers, graph.with_role(Role.CLIENT, name)):
            shown = name.removesuffix(SEND_GOAL)
            if server.type != client.type:
                offered, called = (e.type.removesuffix('_SendGoal') for e in (server, client))
                yield Finding(
                    shown,
                    f'{_node(graph, server)} offers {offered}, but {_node(graph, client)} '
                    f'calls {called}, so that no call arrives',
                    'use one type in both, or another name',
                )
            elif _defined_differently(server, client):
                yield _two_definitions(graph, shown, server, client)


def _defined_differently(one: Endpoint, other: Endpoint) -> bool:
    """Return whether the fields of a type differ, as after it was changed and one built anew.

    REP 2016: the hash covers the structure alone. Where nobody tells it, nobody knows.
    """
    return bool(one.type_hash and other.type_hash and one.type_hash != other.type_hash)


def _two_definitions(graph: Graph, name: str, one: Endpoint, other: Endpoint) -> Finding:
    return Finding(
        name,
        f'{_node(graph, one)} and {_node(graph, other)} have different definitions of '
        f'{one.type.removesuffix("_SendGoal")}, so that what arrives is wrong, or nothing does',
        'build both with the same definition, then start both again',
    )


def check_qos(graph: Graph, topic: str | None = None) -> Iterator[Finding]:
    """Find publishers that offer less than a subscription of the same topic requests."""
    for name in graph.topics():
        if topic not in (None, name):
            continue
        publishers = graph.with_role(Role.PUBLISHER, name)
        subscriptions = graph.with_role(Role.SUBSCRIPTION, name)
        for publisher, subscription in _pairs(publishers, subscriptions):
            if publisher.type != subscription.type:
                continue
            for offered, requested, mend in incompatibilities(publisher.qos, subscription.qos):
                yield Finding(
                    name,
                    f'{_node(graph, publisher)} offers {offered}, but '
                    f'{_node(graph, subscription)} requests {requested}, so that nothing arrives',
                    mend,
                )


def incompatibilities(offered: Qos, requested: Qos) -> Iterator[tuple[str, str, str]]:
    """Yield what is offered, what is requested and what to do, for each policy that does not fit.

    The rules are those of DDS 1.4, 2.2.3 ("requested / offered").
    """
    if requested.reliable and not offered.reliable:
        yield (
            'BEST_EFFORT',
            'RELIABLE',
            'subscribe with `reliability=ReliabilityPolicy.BEST_EFFORT` '
            '(`qos_profile_sensor_data`), or publish with RELIABLE',
        )
    if requested.transient_local and not offered.transient_local:
        yield (
            'VOLATILE',
            'TRANSIENT_LOCAL',
            'subscribe with `durability=DurabilityPolicy.VOLATILE`, or publish with '
            'TRANSIENT_LOCAL',
        )
    if _is_longer(offered.deadline_ns, requested.deadline_ns):
        yield (
            f'deadline {_seconds(offered.deadline_ns)}',
            f'deadline {_seconds(requested.deadline_ns)}',
            'request a longer deadline, or offer a shorter one',
        )
    if requested.manual_liveliness and not offered.manual_liveliness:
        yield (
            'AUTOMATIC liveliness',
            'MANUAL_BY_TOPIC liveliness',
            'subscribe with `liveliness=LivelinessPolicy.AUTOMATIC`',
        )
    if _is_longer(offered.liveliness_lease_ns, requested.liveliness_lease_ns):
        yield (
            f'liveliness lease {_seconds(offered.liveliness_lease_ns)}',
            f'liveliness lease {_seconds(requested.liveliness_lease_ns)}',
            'request a longer lease, or offer a shorter one',
        )


def _pairs(offering: list[Endpoint], using: list[Endpoint]) -> Iterator[tuple[Endpoint, Endpoint]]:
    """Yield every pair of different kinds once: twenty equal subscribers have one fault."""
    seen = set()
    for offer in offering:
        for use in using:
            kind = (*(offer.type, offer.type_hash, offer.qos), *(use.type, use.type_hash, use.qos))
            if kind not in seen:
                seen.add(kind)
                yield offer, use


def _node(graph: Graph, endpoint: Endpoint) -> str:
    return shown_name(graph.node_of(endpoint))


def _is_longer(offered_ns: int | None, requested_ns: int | None) -> bool:
    if requested_ns is None:
        return False
    return offered_ns is None or offered_ns > requested_ns


def _seconds(nanoseconds: int | None) -> str:
    return 'infinite' if nanoseconds is None else f'{nanoseconds * 1e-9:g} s'
