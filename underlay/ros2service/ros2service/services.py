# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Call services from the command line."""

from __future__ import annotations

from typing import Any

from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode

READY_TIMEOUT_SEC = 5.0


def call(
    node: CommandNode,
    service_class: Any,
    name: str,
    request: Any,
    *,
    timeout_sec: float | None = READY_TIMEOUT_SEC,
) -> Any:
    """Call a service and return its response.

    :param timeout_sec: how long to wait for the service, and then for its answer.
    :raises CommandError: one of the two took longer, or the call failed.
    """
    client = node.node.create_client(service_class, name)
    if not node.spin_until(client.service_is_ready, READY_TIMEOUT_SEC):
        raise CommandError(f"Wait for service timed out: '{name}' does not answer")
    future = client.call_async(request)
    if not node.spin_until(future.done, timeout_sec):
        raise CommandError(
            f"'{name}' gave no answer within {timeout_sec:g} s; its node is busy or stopped"
        )
    node.node.destroy_client(client)
    if future.exception() is not None:
        raise CommandError(f"Exception while calling service '{name}': {future.exception()}")
    return future.result()
