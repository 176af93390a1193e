# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Wait for messages."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
import contextlib
import functools
import threading
from typing import Any
import uuid

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor


class WaitForTopics:
    """Waits until a message has come on each of some topics, with a node of its own.

    As a context manager it waits at once, raises RuntimeError where a topic stays silent, and
    shuts down at the end.

    :param topic_tuples: names of topics and the classes of their messages.
    :param timeout: seconds to wait.
    :param messages_received_buffer_length: so many messages of each topic are kept, the last ones.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, Any]],
        timeout: float | None = 5.0,
        messages_received_buffer_length: int | None = 10,
    ) -> None:
        self.topic_tuples = list(topic_tuples)
        self.timeout = timeout
        self.messages_received_buffer_length = messages_received_buffer_length
        self._messages: dict[str, deque[Any]] = {}
        self._all_received = threading.Event()
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        name = f'_test_node_{uuid.uuid4().hex[:10]}'
        self._node = rclpy.create_node(name, context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()

    def wait(self) -> bool:
        """Forget what has come, and wait; return whether each topic has sent in time."""
        self._all_received.clear()
        for messages in self._messages.values():
            messages.clear()
        for topic, message_class in self.topic_tuples:
            if topic not in self._messages:
                self._messages[topic] = deque(maxlen=self.messages_received_buffer_length)
                self._node.create_subscription(
                    message_class, topic, functools.partial(self._on_message, topic), 10
                )
        return self._all_received.wait(self.timeout)

    def _on_message(self, topic: str, message: Any) -> None:
        self._messages[topic].append(message)
        if not self.topics_not_received():
            self._all_received.set()

    def shutdown(self) -> None:
        """Destroy the node; may be called twice."""
        self._context.try_shutdown()
        self._thread.join()
        self._node.destroy_node()

    def topics_received(self) -> set[str]:
        """Return the topics that have sent."""
        return {topic for topic, messages in list(self._messages.items()) if messages}

    def topics_not_received(self) -> set[str]:
        """Return the topics that have not sent."""
        return {topic for topic, _ in self.topic_tuples} - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the last messages of a topic.

        :raises KeyError: it is not one that is waited for.
        """
        if topic_name not in self._messages:
            raise KeyError(f'No messages received for topic: {topic_name}')
        return list(self._messages[topic_name])

    def __enter__(self) -> WaitForTopics:
        if not self.wait():
            silent = ', '.join(sorted(self.topics_not_received()))
            self.shutdown()
            raise RuntimeError(f'Did not receive messages on these topics: {silent}')
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()
