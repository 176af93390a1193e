# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions after a while of ROS time."""

from __future__ import annotations

from typing import Any

from launch.actions import TimerAction
from launch.actions.timer_action import Alarm
from launch.events import TimerEvent
from launch.frontend import expose_action
from launch.launch_context import LaunchContext

from ..ros_adapters import get_ros_node


class _RosAlarm:
    """A timer of a node that rings once, in the thread of the node."""

    def __init__(self, context: LaunchContext, period_sec: float, event: TimerEvent) -> None:
        self._context = context
        self._event = event
        self._timer: Any = get_ros_node(context).create_timer(period_sec, self._ring)

    def _ring(self) -> None:
        self._timer.cancel()
        loop = self._context.asyncio_loop
        if loop is not None:
            loop.call_soon_threadsafe(self._context.emit_event_sync, self._event)

    def cancel(self) -> None:
        self._timer.cancel()


@expose_action('ros_timer')
class ROSTimer(TimerAction):
    """Executes its actions after a period of ROS time, simulated where ``use_sim_time`` is set."""

    def _start_alarm(self, context: LaunchContext, period_sec: float, event: TimerEvent) -> Alarm:
        return _RosAlarm(context, period_sec, event)


RosTimer = ROSTimer
