# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Start a process in a launch that runs, and look at it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import contextlib
from typing import Any

from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess
from launch.events import IncludeLaunchDescription, matches_action
from launch.events.process import ProcessExited, ProcessIO, ProcessStarted, ShutdownProcess
from launch.utilities import ensure_argument_type

from ..io_handler import ActiveIoHandler
from ..proc_info_handler import ActiveProcInfoHandler
from ..text_matching import decode_output


class _Waited:
    """True where a condition came true; shows the last output, for the message of an assert."""

    def __init__(self, came_true: bool, output: str | None) -> None:
        self._came_true = came_true
        self._output = output

    def __bool__(self) -> bool:
        return self._came_true

    def __repr__(self) -> str:
        return f'<{self._came_true}, with the output {self._output!r}>'


class ProcessProxy:
    """What a test sees of a process; from any thread.

    :param output_filter: a function of text that leaves out what the test does not care for.
    """

    def __init__(
        self,
        process_action: ExecuteProcess,
        proc_info: ActiveProcInfoHandler,
        proc_output: ActiveIoHandler,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        ensure_argument_type(process_action, ExecuteProcess, 'process_action')
        ensure_argument_type(proc_info, ActiveProcInfoHandler, 'proc_info')
        ensure_argument_type(proc_output, ActiveIoHandler, 'proc_output')
        if output_filter is not None and not callable(output_filter):
            raise TypeError(f'output_filter={output_filter!r} is not callable')
        self._process_action = process_action
        self._proc_info = proc_info
        self._proc_output = proc_output
        self._output_filter = output_filter

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait for the process to end; return whether it did within so many seconds."""
        changed = self._proc_info.proc_event
        with changed:
            return changed.wait_for(lambda: self.terminated, timeout=timeout)

    def wait_for_output(
        self, condition: Callable[[str], object] | None = None, timeout: float | None = None
    ) -> _Waited:
        """Wait until the process runs and its output is such; return whether that came true.

        :param condition: a function of all output so far; None where any will do.
        :param timeout: seconds; None without end.
        """
        if condition is not None and not callable(condition):
            raise TypeError(f'condition={condition!r} is not callable')
        seen: str | None = None

        def holds() -> bool:
            nonlocal seen
            if not self.running:
                return False
            seen = self.output
            return condition is None or bool(condition(seen))

        changed = self._proc_output.io_event
        with changed:
            return _Waited(changed.wait_for(holds, timeout=timeout), seen)

    @property
    def target_process_action(self) -> ExecuteProcess:
        return self._process_action

    @property
    def stderr(self) -> str:
        return self._text(lambda event: event.from_stderr)

    @property
    def stdout(self) -> str:
        return self._text(lambda event: event.from_stdout)

    @property
    def output(self) -> str:
        return self._text(lambda _event: True)

    def _text(self, is_wanted: Callable[[ProcessIO], bool]) -> str:
        text = decode_output(filter(is_wanted, self._proc_output[self._process_action]))
        return text if self._output_filter is None else self._output_filter(text)

    @property
    def running(self) -> bool:
        return isinstance(self._last_event, ProcessStarted)

    @property
    def terminated(self) -> bool:
        return isinstance(self._last_event, ProcessExited)

    @property
    def _last_event(self) -> ProcessStarted | ProcessExited | None:
        if self._process_action not in self._proc_info.processes():
            return None
        return self._proc_info[self._process_action]

    @property
    def exit_code(self) -> int:
        """The exit status of a process that has ended."""
        return self._proc_info[self._process_action].returncode  # type: ignore[union-attr]


@contextlib.contextmanager
def launch_process(
    launch_service: LaunchService,
    process_action: ExecuteProcess,
    proc_info: ActiveProcInfoHandler,
    proc_output: ActiveIoHandler,
    **kwargs: Any,
) -> Iterator[ProcessProxy]:
    """Start a process in a launch that runs, for as long as the context lasts.

    The other arguments are those of ProcessProxy.
    """
    ensure_argument_type(process_action, ExecuteProcess, 'process_action')
    launch_service.emit_event(IncludeLaunchDescription(LaunchDescription([process_action])))
    proxy = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    try:
        yield proxy
    finally:
        if not proxy.terminated:
            launch_service.emit_event(
                ShutdownProcess(process_matcher=matches_action(process_action))
            )
