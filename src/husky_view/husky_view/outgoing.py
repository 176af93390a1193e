# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What waits to be sent to the tabs, pushed by any thread."""

import asyncio
from typing import Any

from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer


class LoopEvent(asyncio.Event):
    """An event that does nothing where it is set outside of the thread of its loop."""

    def set(self) -> None:
        """Wake all who wait."""
        if asyncio._get_running_loop() is not None:
            super().set()


class MessageBuffer(AsyncMessageBuffer):
    """
    The buffer of viser's server, into which any thread may push.

    That of viser 1.1 sets its event at once, in the thread that pushes, and then again in the
    server's. asyncio's events are not thread-safe: if a tab that waits wakes up amid the first
    time, what pushes ends by a RuntimeError, and with it the view.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.message_event = LoopEvent()


def use_thread_safe_buffers() -> None:
    """Let every server of viser that starts from now on have these; may be called twice."""
    _infra.AsyncMessageBuffer = MessageBuffer  # type: ignore[misc]
