# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ask a server of transforms instead of listening to all of them."""

from __future__ import annotations

import threading
from typing import Any
import warnings

from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_py import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from tf2_ros.buffer_interface import BufferInterface

EXCEPTIONS = {
    TF2Error.LOOKUP_ERROR: LookupException,
    TF2Error.CONNECTIVITY_ERROR: ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: TimeoutException,
}


class BufferClient(BufferInterface):
    """Looks up by the action of a `buffer_server`; another thread has to spin the node.

    :param ns: name of the action, `tf2_buffer_server` by default of the server.
    :param check_frequency: kept as an attribute; an answer is waited for, not looked for.
    :param timeout_padding: how long an answer may take over the timeout of a lookup.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = Duration(seconds=2.0),  # noqa: B008 - never changed
    ) -> None:
        # With what it imports it would take a tenth of the start of all that use only tf2_ros.
        from rclpy.action import ActionClient

        super().__init__()
        self.node = node
        self.action_client = ActionClient(node, LookupTransform, action_name=ns)
        self.check_frequency = check_frequency
        self.timeout_padding = timeout_padding

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return what takes coordinates in the source frame into the target frame.

        :raises TransformException: there is none, or no server; which class says why.
        """
        if isinstance(time, TimeMessage):
            warnings.warn(
                'Passing a builtin_interfaces.msg.Time argument is deprecated, and will be '
                'removed in the near future. Use rclpy.time.Time instead.',
                stacklevel=2,
            )
            time = Time.from_msg(time)
        elif not isinstance(time, Time):
            raise TypeError('Must pass a rclpy.time.Time object.')
        goal = LookupTransform.Goal()
        goal.target_frame = target_frame
        goal.source_frame = source_frame
        goal.source_time = time.to_msg()
        goal.timeout = timeout.to_msg()
        goal.advanced = False
        return self._process(goal)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return what takes the source frame at one time into the target frame at another."""
        goal = LookupTransform.Goal()
        goal.target_frame = target_frame
        goal.source_frame = source_frame
        goal.source_time = source_time.to_msg()
        goal.timeout = timeout.to_msg()
        goal.target_time = target_time.to_msg()
        goal.fixed_frame = fixed_frame
        goal.advanced = True
        return self._process(goal)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> bool:
        """Say whether there is a transform, at the latest after the timeout."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> bool:
        """Say whether there is a transform between two times."""
        try:
            self.lookup_transform_full(
                target_frame, target_time, source_frame, source_time, fixed_frame, timeout
            )
        except TransformException:
            return False
        return True

    def destroy(self) -> None:
        """Give up the action's client."""
        self.action_client.destroy()

    def _process(self, goal: Any) -> TransformStamped:
        if not self.action_client.server_is_ready():
            raise TimeoutException('The BufferServer is not ready.')
        timeout = Duration.from_msg(goal.timeout)
        allowed_ns = timeout.nanoseconds + self.timeout_padding.nanoseconds
        answered = threading.Event()
        future = self.action_client.send_goal_async(goal)
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(allowed_ns * 1e-9):
            raise TimeoutException(
                'The LookupTransform goal sent to the BufferServer did not come back in the '
                'specified time. Something is likely wrong with the server.'
            )
        handle = future.result()
        if not handle.accepted:
            raise TimeoutException(
                'The LookupTransform goal sent to the BufferServer did not come back with '
                'accepted status. Something is likely wrong with the server.'
            )
        return _transform_of(handle.get_result().result)


def _transform_of(result: Any) -> TransformStamped:
    if result is None or result.error is None:
        raise TransformException(
            'The BufferServer returned None for result or result.error!  Something is likely '
            'wrong with the server.'
        )
    if result.error.error != TF2Error.NO_ERROR:
        kind = EXCEPTIONS.get(result.error.error, TransformException)
        raise kind(result.error.error_string)
    return result.transform
