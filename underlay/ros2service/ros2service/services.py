# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Call services from the command line."""

from __future__ import annotations

from typing import Any

from ros2cli.errors import CommandError
from ros2cli.node.direct import CommandNode

_TIMEOUT_SEC = 5.0


def call(node: CommandNode, service_class: Any, name: str, request: Any) -> Any:
    """Call a service and return its response.

    :raises CommandError: the service or its answer took longer than 5 s, or the call failed.
    """
    client = node.node.create_client(service_class, name)
    if not node.spin_until(client.service_is_ready, _TIMEOUT_SEC):
        raise CommandError(f"Wait for service timed out: '{name}' does not answer")
    future = client.call_async(request)
    if not node.spin_until(future.done, _TIMEOUT_SEC):
        raise CommandError(
            f"'{name}' gave no answer within {_TIMEOUT_SEC:g} s; its node is busy or stopped"
        )
    node.node.destroy_client(client)
    if future.exception() is not None:
        raise CommandError(f"Exception while calling service '{name}': {future.exception()}")
    return future.result()
