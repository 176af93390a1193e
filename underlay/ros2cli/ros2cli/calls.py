# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Call services of other nodes from the command line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
import math
import sys
import time
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.task import Future

from ros2cli.discovery import SOON_SEC, why_unanswered
from ros2cli.errors import CommandError, ServiceTimeout

TIMEOUT_SEC = 5.0
_POLL_SEC = 0.02


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

    On a busy machine an answer can be lost: rmw_fastrtps drops it where the server has not found
    a client, which has found it, within 100 ms of the answer ("client will not receive response").

    :param took_sec: is given how long each answer took that came.
    """
    node = getattr(node, 'node', node)
    clients = {name: node.create_client(service_class, name) for name in requests}
    try:
        _spin_until(
            node, lambda: all(each.service_is_ready() for each in clients.values()), TIMEOUT_SEC
        )
        futures = {
            name: client.call_async(requests[name])
            for name, client in clients.items()
            if client.service_is_ready()
        }
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
    finally:
        for client in clients.values():
            node.destroy_client(client)


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
