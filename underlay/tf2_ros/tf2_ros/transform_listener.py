# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Hear the transforms that others send, and put them into a buffer."""

from __future__ import annotations

from contextlib import suppress
from threading import Event, Thread

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.exceptions import InvalidHandle
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from tf2_ros.buffer import Buffer

_LATENCY_SEC = 0.1
_AUTHORITY = 'default_authority'  # rclpy does not say who has sent a message


class TransformListener:
    """Subscribes to /tf and /tf_static while it is kept.

    :param spin_thread: spin the node in a thread of its own: then a callback may wait for a
        transform, and nobody else may spin the node.
    :param qos: a profile or a depth, for /tf.
    :param static_qos: the same for /tf_static.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
    ) -> None:
        self.buffer = buffer
        self.node = node
        # Another callback of the node may wait for what these bring.
        self.group = ReentrantCallbackGroup()
        self.tf_sub = node.create_subscription(
            TFMessage,
            '/tf',
            self.callback,
            _profile(DurabilityPolicy.VOLATILE) if qos is None else qos,
            callback_group=self.group,
        )
        self.tf_static_sub = node.create_subscription(
            TFMessage,
            '/tf_static',
            self.static_callback,
            _profile(DurabilityPolicy.TRANSIENT_LOCAL) if static_qos is None else static_qos,
            callback_group=self.group,
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor()
            self._ended = Event()
            self.dedicated_listener_thread = Thread(
                target=_spin, args=(self.executor, node, self._ended), name='tf listener'
            )
            self.dedicated_listener_thread.start()

    def __del__(self) -> None:
        if hasattr(self, 'dedicated_listener_thread'):
            self._ended.set()
            with suppress(InvalidHandle):  # at the end of a program parts may go before the whole
                self.executor.shutdown()
            self.dedicated_listener_thread.join()
        self.unregister()

    def unregister(self) -> None:
        """Hear no more."""
        for name in ('tf_sub', 'tf_static_sub'):
            if hasattr(self, name):
                self.node.destroy_subscription(getattr(self, name))

    def callback(self, data: TFMessage) -> None:
        for transform in data.transforms:
            self.buffer.set_transform(transform, _AUTHORITY)

    def static_callback(self, data: TFMessage) -> None:
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, _AUTHORITY)


def _profile(durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(depth=100, durability=durability, history=HistoryPolicy.KEEP_LAST)


def _spin(executor: SingleThreadedExecutor, node: Node, ended: Event) -> None:
    executor.add_node(node)
    with suppress(ExternalShutdownException):
        # Always with a timeout: without one rclpy 7.1.6 may miss a Ctrl-C, and Python's end would
        # wait for this thread for ever.
        while node.context.ok() and not ended.is_set():
            executor.spin_once(timeout_sec=_LATENCY_SEC)
    executor.remove_node(node)
