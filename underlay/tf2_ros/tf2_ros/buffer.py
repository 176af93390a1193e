# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A buffer of transforms that can wait for one."""

from __future__ import annotations

from collections.abc import Callable
import threading
from time import sleep
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.clock import Clock, JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tf2_msgs.srv import FrameGraph
from tf2_py import BufferCore

from tf2_ros.buffer_interface import BufferInterface

_POLL_SEC = 0.02
# A clock that goes back by more has jumped, and the wait on it would last too long.
_JUMP_BACK = Duration(seconds=3.0)


class Buffer(BufferCore, BufferInterface):
    """Keeps the newest transforms, and forgets them when time jumps back.

    :param cache_time: how long a transform is kept; None: 10 s.
    :param node: has the service `tf2_frames` then, which lists the frames.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._new_data_callbacks: list[Callable[[], None]] = []
        self._callbacks_to_remove: list[Callable[[], None]] = []
        self._callbacks_lock = threading.RLock()
        if node is not None:
            self.srv = node.create_service(FrameGraph, 'tf2_frames', self._on_frames_asked)
        self.clock = Clock() if node is None else node.get_clock()
        threshold = JumpThreshold(
            min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True
        )
        self.jump_handle = self.clock.create_jump_callback(
            threshold, post_callback=self.time_jump_callback
        )

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        """Forget what was measured before time went back."""
        get_logger('tf2_buffer').warning('Detected jump back in time. Clearing tf buffer.')
        self.clear()

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        super().set_transform(transform, authority)
        self._call_new_data_callbacks()

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        super().set_transform_static(transform, authority)
        self._call_new_data_callbacks()

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008 - never changed
    ) -> TransformStamped:
        """Return what takes coordinates in the source frame into the target frame.

        With a timeout it waits in this thread. Where that is the only one of the executor, no
        transform arrives meanwhile: `TransformListener(..., spin_thread=True)` has its own.

        :param time: 0: the newest that all frames on the way have.
        :raises TransformException: there is none; which class says why.
        """
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_async(
        self, target_frame: str, source_frame: str, time: Time
    ) -> TransformStamped:
        """Wait for a transform without blocking the executor, and return it."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return what takes the source frame at one time into the target frame at another.

        :param fixed_frame: what has not moved between the two times.
        """
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self.can_transform_full(*asked, timeout)
        return self.lookup_transform_full_core(*asked)

    async def lookup_transform_full_async(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
    ) -> TransformStamped:
        """Wait for a transform between two times without blocking the executor."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*asked)
        return self.lookup_transform_full_core(*asked)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration = Duration(),  # noqa: B008
        return_debug_tuple: bool = False,
    ) -> Any:
        """Say whether there is a transform, at the latest after the timeout.

        :param return_debug_tuple: return with it what is missing.
        """

        def ask() -> tuple[int, str]:
            return self.can_transform_core(target_frame, source_frame, time)

        answer = _ask_until(ask, timeout)
        return answer if return_debug_tuple else answer[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
        return_debug_tuple: bool = False,
    ) -> Any:
        """Say whether there is a transform between two times."""

        def ask() -> tuple[int, str]:
            return self.can_transform_full_core(
                target_frame, target_time, source_frame, source_time, fixed_frame
            )

        answer = _ask_until(ask, timeout)
        return answer if return_debug_tuple else answer[0]

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Future:
        """Return a future that is done, with the transform, as soon as there is one."""
        asked = (target_frame, source_frame, time)
        return self._future(
            lambda: bool(self.can_transform_core(*asked)[0]),
            lambda: self.lookup_transform_core(*asked),
        )

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
    ) -> Future:
        """Return a future that is done as soon as there is a transform between two times."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future(
            lambda: bool(self.can_transform_full_core(*asked)[0]),
            lambda: self.lookup_transform_full_core(*asked),
        )

    def _future(self, can: Callable[[], bool], lookup: Callable[[], TransformStamped]) -> Future:
        future = Future()

        def on_new_data() -> None:
            try:
                if not future.done() and can():
                    future.set_result(lookup())
            except BaseException as error:  # whoever waits gets it
                future.set_exception(error)

        with self._callbacks_lock:  # no data may come between the question and the entry
            if can():
                future.set_result(lookup())
                return future
            self._new_data_callbacks.append(on_new_data)
        future.add_done_callback(lambda _: self._remove_callback(on_new_data))
        return future

    def _call_new_data_callbacks(self) -> None:
        with self._callbacks_lock:
            for callback in self._new_data_callbacks:
                callback()
            for callback in self._callbacks_to_remove:
                self._new_data_callbacks.remove(callback)
            self._callbacks_to_remove.clear()

    def _remove_callback(self, callback: Callable[[], None]) -> None:
        """Have a callback removed after the round of calls in which this may be."""
        with self._callbacks_lock:
            self._callbacks_to_remove.append(callback)

    def _on_frames_asked(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response


def _ask_until(ask: Callable[[], tuple[int, str]], timeout: Duration) -> tuple[int, str]:
    """Ask repeatedly until the answer is yes, or the timeout has passed on the system's clock."""
    clock = Clock()
    start = clock.now()
    answer = ask()
    while not answer[0] and start - _JUMP_BACK <= clock.now() < start + timeout:
        sleep(_POLL_SEC)
        answer = ask()
    return answer
