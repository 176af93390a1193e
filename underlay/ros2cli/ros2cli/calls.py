# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Call services of other nodes from the command line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, ExitStack
from functools import partial
import math
import sys
import time
from typing import Any

from rcl_interfaces.srv import ListParameters
import rclpy
from rclpy.node import Node, NodeNameNonExistentError
from rclpy.task import Future
from rtps_graph.names import full_node_name

from ros2cli.discovery import SOON_SEC, why_unanswered
from ros2cli.errors import CommandError, ServiceTimeout

TIMEOUT_SEC = 5.0
_POLL_SEC = 0.02
_ASK_AGAIN_SEC = 0.4


def call(
    node: Any,
    service_class: Any,
    name: str,
    request: Any,
    *,
    may_take_long: bool = False,
    only_asks: bool = False,
) -> Any:
    """Call a service and return its response.

    :param node: what calls: a node of rclpy, or one of ros2cli, which has such a node.
    :param may_take_long: await the answer for as long as the service is there; after 5 s a hint
        on stderr says so.
    :param only_asks: the request changes nothing, so it is sent once more where no answer comes.
    :raises CommandError: the service or its answer took longer than 5 s, or the call failed.
    """
    (answer,) = call_all(
        node,
        service_class,
        {name: request},
        may_take_long=may_take_long,
        only_asks=only_asks,
    ).values()
    if isinstance(answer, Exception):
        raise answer
    return answer


def call_all(
    node: Any,
    service_class: Any,
    requests: Mapping[str, Any],
    *,
    may_take_long: bool = False,
    only_asks: bool = False,
    took_sec: dict[str, float] | None = None,
) -> dict[str, Any]:
    """Call services side by side; return for each name its response, or what `call` raises.

    Where an answer may be lost, see `found`, what only asks is sent once more; what does more is
    sent once, when its server has found the client.

    :param took_sec: is given how long each answer took that came.
    """
    node = getattr(node, 'node', node)
    clients = {name: node.create_client(service_class, name) for name in requests}
    with ExitStack() as closing:
        for client in clients.values():
            closing.callback(node.destroy_client, client)
        _spin_until(
            node, lambda: all(each.service_is_ready() for each in clients.values()), TIMEOUT_SEC
        )
        ready = {name: each for name, each in clients.items() if each.service_is_ready()}
        if not only_asks:
            services = [client.service_name for client in ready.values()]
            closing.enter_context(found(node, services, partial(_spin_until, node)))
        futures = {name: each.call_async(requests[name]) for name, each in ready.items()}
        begin = time.monotonic()
        took_sec = {} if took_sec is None else took_sec

        def have_answered(names: Iterable[str]) -> bool:
            for name in names:
                if futures[name].done():
                    took_sec.setdefault(name, time.monotonic() - begin)
            return all(name in took_sec for name in names)

        _spin_until(node, lambda: have_answered(futures), SOON_SEC)
        waiting = [name for name, future in futures.items() if not future.done()]
        in_vain = why_unanswered(waiting) if waiting else {}
        awaited = [name for name in waiting if name not in in_vain]
        if only_asks:
            futures |= {name: clients[name].call_async(requests[name]) for name in awaited}
        _spin_until(node, lambda: have_answered(awaited), TIMEOUT_SEC - SOON_SEC)
        if may_take_long:
            late = [name for name in awaited if not futures[name].done()]
            _await_late(node, {name: (clients[name], futures[name]) for name in late})
        gone = {name for name in waiting if not clients[name].service_is_ready()}
        in_vain |= {name: no_server(name) for name in gone}
        return {name: _outcome(name, futures.get(name), in_vain.get(name)) for name in requests}


@contextmanager
def found(
    node: Node, services: Iterable[str], spin_until: Callable[[Callable[[], bool], float], Any]
) -> Iterator[None]:
    """Wait until the servers of services have found the clients that `node` has made.

    On a busy machine a client may have found a server that has not found it. rmw_fastrtps gives
    such a server 100 ms and drops its answer then ("client will not receive response"), though
    what was called is done. DDS announces endpoints in the order in which they were made, so that
    a node which answers a client of now has found the older ones, too. Its parameters are asked
    for: that changes nothing. Who answers nothing, or has no parameters, is not waited for longer
    than 1 s; what is still asked then is taken at the end, for a server that finds a client gone
    waits 100 ms, too, and warns.

    :param spin_until: spins `node` until a condition holds or a time in s is over.
    """
    end = time.monotonic() + SOON_SEC
    known: dict[str, set[str]] = {}

    def know_servers() -> bool:
        known.update(_parameter_services(node, services))
        return all(name in known for name in services)

    spin_until(know_servers, SOON_SEC)
    clients = [node.create_client(ListParameters, name) for name in set().union(*known.values())]
    asked: dict[Any, list[Future]] = {client: [] for client in clients}

    def have_answered() -> bool:
        return all(any(each.done() for each in futures) for futures in asked.values())

    def is_nothing_left() -> bool:
        """Tell whether the last request is answered, which is when the others are, or lost."""
        return all(
            not futures or futures[-1].done() or not client.service_is_ready()
            for client, futures in asked.items()
        )

    try:
        spin_until(
            lambda: all(each.service_is_ready() for each in clients), end - time.monotonic()
        )
        while not have_answered() and time.monotonic() < end:
            for client, futures in asked.items():
                futures.append(client.call_async(ListParameters.Request()))
            spin_until(have_answered, _ASK_AGAIN_SEC)
        yield
        spin_until(is_nothing_left, SOON_SEC)
    finally:
        for client in clients:
            node.destroy_client(client)


def _parameter_services(node: Node, services: Iterable[str]) -> dict[str, set[str]]:
    """Map the services whose servers are known to what those list their parameters by."""
    found: dict[str, set[str]] = {}
    for name, namespace in node.get_node_names_and_namespaces():
        try:
            pairs = node.get_service_names_and_types_by_node(name, namespace)
        except NodeNameNonExistentError:  # it has just ended
            continue
        offered = {service for service, _ in pairs}
        lists = {f'{full_node_name(namespace, name)}/list_parameters'} & offered
        for service in offered.intersection(services):
            found.setdefault(service, set()).update(lists)
    return found


def _await_late(node: Node, calls: Mapping[str, tuple[Any, Future]]) -> None:
    """Wait until each service, by its name, has answered or is gone."""
    for name in calls:
        print(f'hint: {no_answer(name)}; Ctrl-C ends the waiting', file=sys.stderr)
    _spin_until(
        node,
        lambda: all(
            future.done() or not client.service_is_ready() for client, future in calls.values()
        ),
        math.inf,
    )


def _spin_until(node: Node, done: Callable[[], bool], timeout_sec: float) -> None:
    executor = node.executor or rclpy.get_global_executor()
    added = executor.add_node(node)
    end = time.monotonic() + timeout_sec
    try:
        while not done() and time.monotonic() < end:
            executor.spin_once(_POLL_SEC)
    finally:
        if added:
            executor.remove_node(node)


def _outcome(name: str, future: Any, in_vain: str | None) -> Any:
    if future is None:
        return ServiceTimeout(f"Wait for service timed out: '{name}' does not answer")
    if not future.done():
        return CommandError(in_vain or no_answer(name))
    if future.exception() is not None:
        return CommandError(f"Exception while calling service '{name}': {future.exception()}")
    return future.result()


def no_answer(name: str) -> str:
    """Say that a service has not answered in time."""
    return (
        f"'{name}' gave no answer within {TIMEOUT_SEC:g} s; its node is busy or stopped, or "
        'waits in a callback for another one (`ros2 doctor` says more)'
    )


def no_server(name: str) -> str:
    """Say that a service has ended instead of answering."""
    return (
        f"'{name}' gave no answer: its node has ended, and its terminal says why, as where a "
        'callback returns no response'
    )
