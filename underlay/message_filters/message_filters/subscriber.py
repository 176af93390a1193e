# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A topic as the first of several filters."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile

from message_filters.simple_filter import SimpleFilter


class Subscriber(SimpleFilter):
    """Lets out each message of a topic; what else is asked of it goes to its subscription."""

    def __init__(
        self,
        node: Node,
        msg_type: type[Any],
        topic: str,
        qos_profile: QoSProfile | int = QoSProfile(depth=10),  # noqa: B008 - never changed
        **kwargs: Any,
    ) -> None:
        """Subscribe.

        :param qos_profile: a profile, or how many messages to keep.
        :param kwargs: `callback_group` and what else `create_subscription` takes by name.
        :raises TypeError: the topic is no text.
        """
        super().__init__()
        if not isinstance(topic, str):
            raise TypeError(
                f'topic={topic!r}: must be the name of a topic, as in '
                'Subscriber(node, msg_type, topic, qos_profile)'
            )
        self.node = node
        self.topic = topic
        self.sub = node.create_subscription(
            msg_type=msg_type,
            topic=topic,
            callback=self.callback,
            qos_profile=qos_profile,
            **kwargs,
        )

    def callback(self, msg: Any) -> None:
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the name of the topic as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == 'sub':  # create_subscription has refused, and there is nothing to ask
            raise AttributeError('this Subscriber has no subscription')
        return getattr(self.sub, key)
