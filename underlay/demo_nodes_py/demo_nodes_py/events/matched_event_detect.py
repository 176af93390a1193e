# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Log how publishers and subscriptions find and lose each other."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import sys
from typing import TypeVar

from node_program import in_steps, run_node, Spinner
from rclpy.event_handler import (
    PublisherEventCallbacks,
    QoSPublisherMatchedInfo,
    QoSSubscriptionMatchedInfo,
    SubscriptionEventCallbacks,
)
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription
from std_msgs.msg import String

PUB_TOPIC = 'pub_topic_matched_event_detect'
SUB_TOPIC = 'sub_topic_matched_event_detect'
_WAIT_SEC = 10.0

Endpoint = TypeVar('Endpoint', Publisher, Subscription)


class MatchedEventDetectNode(Node):
    """Has a publisher and a subscription, and logs who matches them."""

    def __init__(self, pub_topic_name: str, sub_topic_name: str) -> None:
        super().__init__('matched_event_detection_node')
        self.events = 0
        self._connected = {'subscription': False, 'publisher': False}
        on_subscription = partial(self._on_matched, 'subscription')
        on_publisher = partial(self._on_matched, 'publisher')
        self.create_publisher(
            String,
            pub_topic_name,
            10,
            event_callbacks=PublisherEventCallbacks(matched=on_subscription),
        )
        self.create_subscription(
            String,
            sub_topic_name,
            lambda _: None,
            10,
            event_callbacks=SubscriptionEventCallbacks(matched=on_publisher),
        )

    def _on_matched(
        self, kind: str, info: QoSPublisherMatchedInfo | QoSSubscriptionMatchedInfo
    ) -> None:
        self.events += 1
        before, self._connected[kind] = self._connected[kind], info.current_count > 0
        if before and info.current_count:
            self.get_logger().info(
                f'The changed number of connected {kind} is {info.current_count_change} and '
                f'current number of connected {kind} is {info.current_count}'
            )
        elif before:
            self.get_logger().info(f'Last {kind} is disconnected.')
        elif info.current_count:
            self.get_logger().info(f'First {kind} is connected.')


class MultiSubNode(Node):
    """Makes subscriptions and destroys them."""

    def __init__(self, topic_name: str) -> None:
        super().__init__('multi_sub_node')
        self._topic_name = topic_name

    def create_one_sub(self) -> Subscription:
        self.get_logger().info('Create a new subscription.')
        return self.create_subscription(String, self._topic_name, lambda _: None, 10)

    def destroy_one_sub(self, sub: Subscription) -> None:
        self.get_logger().info('Destroy a subscription.')
        self.destroy_subscription(sub)


class MultiPubNode(Node):
    """Makes publishers and destroys them."""

    def __init__(self, topic_name: str) -> None:
        super().__init__('multi_pub_node')
        self._topic_name = topic_name

    def create_one_pub(self) -> Publisher:
        self.get_logger().info('Create a new publisher.')
        return self.create_publisher(String, self._topic_name, 10)

    def destroy_one_pub(self, pub: Publisher) -> None:
        self.get_logger().info('Destroy a publisher.')
        self.destroy_publisher(pub)


def _steps(node: MatchedEventDetectNode, spinner: Spinner) -> int:
    subscriptions = spinner.add(MultiSubNode(PUB_TOPIC))
    publishers = spinner.add(MultiPubNode(SUB_TOPIC))

    def notices_each(create: Callable[[], Endpoint], destroy: Callable[[Endpoint], None]) -> None:
        first = notices(create)
        second = notices(create)
        notices(partial(destroy, first))
        notices(partial(destroy, second))

    def notices(change: Callable[[], Endpoint]) -> Endpoint:
        before = node.events
        result = change()
        if not spinner.until(lambda: node.events > before, _WAIT_SEC):
            node.get_logger().warning(f'No matched event within {_WAIT_SEC:g} s')
        return result

    notices_each(subscriptions.create_one_sub, subscriptions.destroy_one_sub)
    notices_each(publishers.create_one_pub, publishers.destroy_one_pub)
    return 0


def main(args: list[str] | None = None) -> int:
    return run_node(
        lambda _: MatchedEventDetectNode(PUB_TOPIC, SUB_TOPIC),
        sys.argv if args is None else args,
        in_steps(_steps),
    )


if __name__ == '__main__':
    sys.exit(main())
