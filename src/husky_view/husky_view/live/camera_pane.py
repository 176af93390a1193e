# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the camera of the driven robot sees, in the panel, while there is a camera."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.subscription import Subscription
from sensor_msgs.msg import Image
import viser

from husky_view.picture.clicks import in_order
from husky_view.picture.page import AT_CAMERA

ENCODING, CHANNELS = 'rgb8', 3
NOTHING = np.zeros((1, 1, CHANNELS), dtype=np.uint8)


class CameraPane:
    """
    A picture that may be switched off: a simulator draws only what somebody looks at.

    :param topics: of the robots' cameras.
    :param later: is given what is to be done when somebody has clicked.
    :param invalid: called with what came that is invalid; it is not drawn.
    :param closing: destroys the subscription.
    """

    def __init__(
        self,
        node: Node,
        gui: viser.GuiApi,
        topics: Sequence[str],
        *,
        later: Callable[[Callable[[], None]], None],
        invalid: Callable[[str], None],
        closing: ExitStack,
    ) -> None:
        self._node = node
        self._topics = topics
        self._invalid = invalid
        self._topic = topics[0]
        self._newest: Image | None = None  # since the last call of draw
        self._subscription: Subscription[Image] | None = None
        self._switch = gui.add_checkbox(
            'What the camera sees', True, visible=False, order=AT_CAMERA
        )
        self._switch.on_update(in_order(lambda _: later(self.look)))
        self._picture = gui.add_image(NOTHING, format='jpeg', visible=False, order=AT_CAMERA)
        closing.callback(self.end)

    def choose_robot(self, place: int) -> None:
        """Show the camera of another robot."""
        self.end()
        self._topic = self._topics[place]
        self.look()

    def look(self) -> None:
        """Show the pane if there is a camera now, else hide it; call it now and then."""
        there = self._node.count_publishers(self._topic) > 0
        wanted = there and bool(self._switch.value)
        _show(self._switch, there)
        if not wanted:
            self.end()
        elif self._subscription is None:
            self._subscription = self._node.create_subscription(
                Image, self._topic, self._on_image, qos_profile_sensor_data
            )

    def draw(self) -> None:
        """Draw the newest picture; a few times a second, however many come."""
        msg, self._newest = self._newest, None
        if msg is None:
            return
        size = msg.height * msg.width * CHANNELS
        if msg.encoding != ENCODING or not size or len(msg.data) != size:
            self._invalid(
                f'{self._topic}: {len(msg.data)} bytes of {msg.encoding!r} are no picture of '
                f'{msg.width} x {msg.height} in {ENCODING}'
            )
            return
        pixels = np.frombuffer(msg.data, dtype=np.uint8)
        self._picture.image = pixels.reshape(msg.height, msg.width, CHANNELS)
        _show(self._picture, True)

    def _on_image(self, msg: Image) -> None:
        self._newest = msg

    def end(self) -> None:
        """Look no more; may be called twice."""
        subscription, self._subscription, self._newest = self._subscription, None, None
        if subscription is not None:
            self._node.destroy_subscription(subscription)
            _show(self._picture, False)


def _show(element: Any, visible: bool) -> None:
    if element.visible != visible:
        element.visible = visible
