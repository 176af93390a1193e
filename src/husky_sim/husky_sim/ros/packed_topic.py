# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topic of a packed message."""

from collections.abc import Callable
from typing import Any

from rclpy.publisher import Publisher

from husky_sim.messages.packed_message import Form, PackedMessage


class PackedTopic:
    """
    A packed message and its publisher: `pack` what is new, then `publish`.

    `Publisher.publish` asks of each message what kind it is, and keeps other threads from
    destroying the publisher meanwhile: a quarter of what a message costs here. A simulator has one
    thread, and knows its bytes; so they go straight to the publisher's handle, where that method
    would send them. Where the handle takes no bytes, that method sends them.

    :param message: with a method `pack`.
    :param form: in which it is published; see `proven_form`.
    """

    def __init__(self, message: Any, publisher: Publisher, form: Form) -> None:
        self.message, self.publisher = message, publisher
        self.pack: Callable[..., None] = message.pack
        self.publish = _sender(message, publisher, form)

    @property
    def is_read(self) -> bool:
        """Whether it has a subscription."""
        return bool(self.publisher.get_subscription_count())


def _sender(message: PackedMessage, publisher: Publisher, form: Form) -> Callable[[], None]:
    send_bytes = getattr(publisher.handle, 'publish_raw', None)
    if form is not bytes or send_bytes is None:
        return lambda: publisher.publish(form(message))
    packed = message.packed
    return lambda: send_bytes(bytes(packed))
