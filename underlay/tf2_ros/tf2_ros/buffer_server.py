# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Answer lookups of others, by the action that a BufferClient asks."""

from __future__ import annotations

import sys
from typing import Any

from node_program import run_node
from rclpy.action import ActionServer
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_py import TransformException

from tf2_ros.buffer import Buffer
from tf2_ros.buffer_client import EXCEPTIONS
from tf2_ros.transform_listener import TransformListener

_CODES = {kind: code for code, kind in EXCEPTIONS.items()}


def main() -> int:
    """Serve until Ctrl-C."""
    return run_node(lambda _: BufferServer(), sys.argv)


class BufferServer(Node):
    """Waits for the transform of each goal as long as the goal says."""

    def __init__(self) -> None:
        super().__init__('tf_buffer')
        size_sec = self.declare_parameter('buffer_size', 120.0).value
        self._buffer = Buffer(Duration(seconds=size_sec))
        self._listener = TransformListener(self._buffer, self)
        self._clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._server = ActionServer(self, LookupTransform, 'tf2_buffer_server', self._on_goal)

    async def _on_goal(self, handle: Any) -> Any:
        goal = handle.request
        await self._wait(goal)
        result = LookupTransform.Result()
        try:
            result.transform = self._lookup(goal)
        except TransformException as error:
            result.error.error = _CODES.get(type(error), TF2Error.TRANSFORM_ERROR)
            result.error.error_string = str(error)
            handle.abort()
        else:
            handle.succeed()
        return result

    async def _wait(self, goal: Any) -> None:
        """Wait until the transform is there, or the goal's time is over."""
        timeout_sec = goal.timeout.sec + 1e-9 * goal.timeout.nanosec
        if timeout_sec <= 0.0:
            return
        if goal.advanced:
            found = self._buffer.wait_for_transform_full_async(*_advanced(goal))
        else:
            found = self._buffer.wait_for_transform_async(*_simple(goal))

        def give_up() -> None:
            if not found.done():
                found.set_result(None)

        timer = self.create_timer(timeout_sec, give_up, clock=self._clock)
        await found
        self.destroy_timer(timer)

    def _lookup(self, goal: Any) -> Any:
        if goal.advanced:
            return self._buffer.lookup_transform_full_core(*_advanced(goal))
        return self._buffer.lookup_transform_core(*_simple(goal))

    def destroy_node(self) -> None:
        self._server.destroy()
        super().destroy_node()


def _simple(goal: Any) -> tuple[Any, ...]:
    return goal.target_frame, goal.source_frame, goal.source_time


def _advanced(goal: Any) -> tuple[Any, ...]:
    return (
        goal.target_frame,
        goal.target_time,
        goal.source_frame,
        goal.source_time,
        goal.fixed_frame,
    )


if __name__ == '__main__':
    sys.exit(main())
