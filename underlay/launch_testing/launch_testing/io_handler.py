# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the processes of a launch write."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
import threading
from typing import Any

from launch.actions import ExecuteLocal
from launch.events.process import ProcessIO

from .asserts.assert_output import assertInStream
from .text_matching import Expected
from .util import NoMatchingProcessException, resolveProcesses


class IoHandler:
    """Holds what processes have written, in order and for each process."""

    def __init__(self) -> None:
        self._events: list[ProcessIO] = []
        self._events_of: dict[str, list[ProcessIO]] = {}

    def track(self, process_name: str) -> None:
        """Know a process that has not written yet."""
        self._events_of.setdefault(process_name, [])

    def append(self, process_io: ProcessIO) -> None:
        self._events.append(process_io)
        self._events_of.setdefault(process_io.process_name, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter(self._events)

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes that have written."""
        return [events[0].action for events in self._events_of.values() if events]

    def process_names(self) -> Iterable[str]:
        """Return the names of the processes that are known."""
        return self._events_of.keys()

    def __getitem__(self, key: str | ExecuteLocal) -> list[ProcessIO]:
        """Return what a process has written, by its full name or its action.

        :raises KeyError: it is not known.
        """
        if isinstance(key, str):
            return list(self._events_of[key])
        if key.process_details is None:
            raise KeyError(key)
        return list(self._events_of[key.process_details['name']])


class ActiveIoHandler:
    """Holds what processes have written while they still run; from any thread."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._io_handler = IoHandler()

    @property
    def io_event(self) -> threading.Condition:
        """The condition that is told of all that comes."""
        return self._changed

    def track(self, process_name: str) -> None:
        """Know a process that has not written yet."""
        with self._changed:
            self._io_handler.track(process_name)
            self._changed.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        with self._changed:
            self._io_handler.append(process_io)
            self._changed.notify_all()

    def __iter__(self) -> Iterator[ProcessIO]:
        with self._changed:
            return iter(list(self._io_handler))

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes that have written."""
        with self._changed:
            return self._io_handler.processes()

    def process_names(self) -> list[str]:
        """Return the names of the processes that are known."""
        with self._changed:
            return list(self._io_handler.process_names())

    def __getitem__(self, key: str | ExecuteLocal) -> list[ProcessIO]:
        """Return what a process has written, by its full name or its action.

        :raises KeyError: it is not known.
        """
        with self._changed:
            return self._io_handler[key]

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:
        """Wait as waitFor does.

        :raises AssertionError: it never came.
        """
        if not self.waitFor(*args, **kwargs):
            raise AssertionError('Waiting for output timed out')

    def waitFor(
        self,
        expected_output: Expected,
        process: ExecuteLocal | str | None = None,
        cmd_args: object = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float | None = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = 'stderr',
    ) -> bool:
        """Wait for output; return whether it came within so many seconds.

        The other arguments are those of assertInStream; without a process any may write it.

        :raises NoMatchingProcessException: no such process has written anything.
        """

        def has_come() -> bool:
            try:
                assertInStream(
                    self._io_handler,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (NoMatchingProcessException, AssertionError):
                return False
            return True

        with self._changed:
            if self._changed.wait_for(has_come, timeout=timeout):
                return True
        # Output of a name that nothing matches could never have come.
        resolveProcesses(self, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return False
