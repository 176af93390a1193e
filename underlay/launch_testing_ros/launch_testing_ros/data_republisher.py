# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Change messages on their way."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class DataRepublisher:
    """Publishes on a topic what comes on another one, changed; the node must be spun.

    :param transform_fn: a function of a message that returns the one to publish, or None to drop
        it.
    """

    def __init__(
        self,
        node: Any,
        listen_topic: str,
        publish_topic: str,
        msg_type: Any,
        transform_fn: Callable[[Any], Any],
    ) -> None:
        self._node = node
        self._transform = transform_fn
        self._received = 0
        self._republished: list[Any] = []
        self._publisher = node.create_publisher(msg_type, publish_topic, 10)
        self._subscription = node.create_subscription(msg_type, listen_topic, self._on_message, 10)

    def shutdown(self) -> None:
        """Stop republishing."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)

    def get_num_received(self) -> int:
        return self._received

    def get_num_republished(self) -> int:
        """Return how many were not dropped."""
        return len(self._republished)

    def get_republished(self) -> list[Any]:
        """Return the received messages that were republished, as they came."""
        return self._republished

    def _on_message(self, message: Any) -> None:
        self._received += 1
        changed = self._transform(message)
        if changed:
            self._republished.append(message)
            self._publisher.publish(changed)
