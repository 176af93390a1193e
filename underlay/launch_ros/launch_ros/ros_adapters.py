# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The one ROS node that a launch itself has, where an action needs it."""

from __future__ import annotations

import os
import threading
from typing import Any, TYPE_CHECKING

from launch.event_handlers import OnShutdown
from launch.launch_context import LaunchContext

if TYPE_CHECKING:
    from rclpy.node import Node

_KEY = 'ros_adapter'


class ROSAdapter:
    """A node spun in a thread of its own, with a context of its own."""

    def __init__(self, *, argv: list[str] | None = None, autostart: bool = True) -> None:
        self.argv = argv or []
        self.__thread: threading.Thread | None = None
        self.ros_context: Any = None
        self.ros_node: Any = None
        self.ros_executor: Any = None
        if autostart:
            self.start()

    def start(self) -> None:
        """Start spinning.

        :raises RuntimeError: it has started already.
        """
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        if self.__thread is not None:
            raise RuntimeError('Cannot start a ROS adapter that is already running')
        self.ros_context = rclpy.Context()
        # The signals belong to the launch.
        rclpy.init(
            args=self.argv,
            context=self.ros_context,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.ros_node = rclpy.create_node(
            f'launch_ros_{os.getpid()}',
            context=self.ros_context,
            use_global_arguments=False,
        )
        self.ros_executor = SingleThreadedExecutor(context=self.ros_context)
        self.ros_executor.add_node(self.ros_node)
        self.__thread = threading.Thread(target=self.__spin, name='launch_ros', daemon=True)
        self.__thread.start()

    def __spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self.ros_executor.spin()
        except (ExternalShutdownException, ShutdownException):
            return

    def shutdown(self) -> None:
        """Stop spinning and destroy the node.

        :raises RuntimeError: it does not run.
        """
        if self.__thread is None:
            raise RuntimeError('Cannot shutdown a ROS adapter that is not running')
        self.ros_context.try_shutdown()
        self.ros_executor.wake()
        self.__thread.join(5.0)
        self.ros_executor.shutdown(timeout_sec=0)
        self.ros_node.destroy_node()
        self.__thread = None


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of this launch, made when first asked for."""
    adapter: ROSAdapter | None = context.get_locals_as_dict().get(_KEY)
    if adapter is None:
        adapter = ROSAdapter()
        context.extend_globals({_KEY: adapter})
        stop = adapter.shutdown
        context.register_event_handler(OnShutdown(on_shutdown=lambda *_: stop()), append=True)
    return adapter


def get_ros_node(context: LaunchContext) -> Node:
    """Return the node of this launch, made when first asked for."""
    return get_ros_adapter(context).ros_node
