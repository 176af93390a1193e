# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Call services from a node that is spun."""

from __future__ import annotations

import contextlib
from typing import Any

from rclpy.node import Node

from playpen_testing.waiting import wait_until


def ask(node: Node, kind: Any, name: str, /, **fields: object) -> Any:
    """
    Call a service from a node that is spun by another thread, and return its response.

    Again where none comes: a server that has not found within 0.1 s who reads its response, on a
    busy machine, drops it.
    """
    client = node.create_client(kind, name)
    wait_until(client.service_is_ready, timeout_sec=20.0, what=f'the service {name}')
    for _ in range(3):
        answer = client.call_async(kind.Request(**fields))
        with contextlib.suppress(AssertionError):
            wait_until(answer.done, timeout_sec=5.0, what='an answer')
            return answer.result()
    raise AssertionError(f'no answer of {name} to three requests')
