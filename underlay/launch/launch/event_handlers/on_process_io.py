# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When a process reads or writes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TYPE_CHECKING

from ..events.process import ProcessIO
from .on_action_event_base import OnActionEventBase

if TYPE_CHECKING:
    from ..actions import ExecuteLocal
    from ..launch_context import LaunchContext

_Handler = Callable[[ProcessIO], Any]


class OnProcessIO(OnActionEventBase):
    """Handles what a process, or any, writes; each function gets the event."""

    def __init__(
        self,
        *,
        target_action: Callable[[ExecuteLocal], bool] | ExecuteLocal | None = None,
        on_stdin: _Handler | None = None,
        on_stdout: _Handler | None = None,
        on_stderr: _Handler | None = None,
        **kwargs: Any,
    ) -> None:
        from ..actions import ExecuteLocal

        def on_io(event: ProcessIO, context: LaunchContext) -> Any:
            del context
            handlers = (
                (event.from_stdin, on_stdin),
                (event.from_stdout, on_stdout),
                (event.from_stderr, on_stderr),
            )
            for applies, handler in handlers:
                if applies and handler is not None:
                    return handler(event)
            return None

        super().__init__(
            action_matcher=target_action,
            on_event=on_io,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )
