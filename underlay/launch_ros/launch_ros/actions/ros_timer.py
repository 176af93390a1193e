# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions after a while of ROS time."""

from __future__ import annotations

import asyncio
from typing import Any, TYPE_CHECKING

from launch.actions import TimerAction
from launch.actions.timer_action import Alarm
from launch.events import TimerEvent
from launch.frontend import expose_action
from launch.launch_context import LaunchContext

from ..ros_adapters import get_ros_node

if TYPE_CHECKING:
    from rclpy.node import Node


class _RosAlarm:
    """A timer of a node that rings once, in the thread of the node.

    It starts when the launch description is through: a SetUseSimTime that follows changes the
    clock, which a running timer would take for a jump back in time.
    """

    def __init__(
        self,
        context: LaunchContext,
        loop: asyncio.AbstractEventLoop,
        period_sec: float,
        event: TimerEvent,
    ) -> None:
        self._context = context
        self._loop = loop
        self._event = event
        self._timer: Any = None
        self._start = loop.call_soon(self._create_timer, get_ros_node(context), period_sec)

    def _create_timer(self, node: Node, period_sec: float) -> None:
        self._timer = node.create_timer(period_sec, self._ring)

    def _ring(self) -> None:
        self._timer.cancel()
        self._loop.call_soon_threadsafe(self._context.emit_event_sync, self._event)

    def cancel(self) -> None:
        self._start.cancel()
        if self._timer is not None:
            self._timer.cancel()


@expose_action('ros_timer')
class ROSTimer(TimerAction):
    """Executes its actions after a period of ROS time: the simulated one after SetUseSimTime."""

    def describe(self) -> str:
        return f'ROSTimer(period={self.period}, actions=<actions>)'

    def _start_alarm(self, context: LaunchContext, period_sec: float, event: TimerEvent) -> Alarm:
        assert context.asyncio_loop is not None
        return _RosAlarm(context, context.asyncio_loop, period_sec, event)


RosTimer = ROSTimer
