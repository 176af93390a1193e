# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""When the processes of a launch start and end, and how."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
import threading

from launch.actions import ExecuteLocal
from launch.events.process import ProcessExited, ProcessStarted

from .util import NoMatchingProcessException, resolveProcesses
from .util.proc_lookup import name_of

_Event = ProcessStarted | ProcessExited


class ProcInfoHandler:
    """Holds the last that happened to each process: that it started, or that it ended."""

    def __init__(self) -> None:
        self._events: dict[ExecuteLocal, _Event] = {}

    def append(self, process_info: _Event) -> None:
        self._events[process_info.action] = process_info

    def __iter__(self) -> Iterator[_Event]:
        return iter(self._events.values())

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions of the processes that have started."""
        return self._events.keys()

    def process_names(self) -> list[str]:
        return [name_of(action) for action in self._events]

    def __getitem__(self, key: str | ExecuteLocal) -> _Event:
        """Return the event of a process, by its action or a part of its name.

        :raises KeyError: there is no such process.
        """
        if not isinstance(key, str):
            return self._events[key]
        for action, event in self._events.items():
            if key in name_of(action):
                return event
        raise KeyError(key)


class ActiveProcInfoHandler:
    """Holds what happened to each process while the launch still runs; from any thread."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._proc_info_handler = ProcInfoHandler()

    @property
    def proc_event(self) -> threading.Condition:
        """The condition that is told of all that happens."""
        return self._changed

    def append(self, process_info: _Event) -> None:
        with self._changed:
            self._proc_info_handler.append(process_info)
            self._changed.notify_all()

    def __iter__(self) -> Iterator[_Event]:
        with self._changed:
            return iter(list(self._proc_info_handler))

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes that have started."""
        with self._changed:
            return list(self._proc_info_handler.processes())

    def process_names(self) -> list[str]:
        with self._changed:
            return self._proc_info_handler.process_names()

    def __getitem__(self, key: str | ExecuteLocal) -> _Event:
        """Return the event of a process, by its action or a part of its name.

        :raises KeyError: there is no such process.
        """
        with self._changed:
            return self._proc_info_handler[key]

    def assertWaitForShutdown(
        self,
        process: ExecuteLocal | str,
        cmd_args: object = None,
        *,
        timeout: float | None = 10,
    ) -> None:
        """Wait until a process has ended.

        :raises AssertionError: it has not within so many seconds.
        """
        if not self.__wait_for(_has_ended, process, cmd_args, timeout):
            raise AssertionError(f"Timed out waiting for process '{process}' to finish")

    def assertWaitForStartup(
        self,
        process: ExecuteLocal | str,
        cmd_args: object = None,
        *,
        timeout: float | None = 10,
    ) -> None:
        """Wait until a process has started.

        :raises AssertionError: it has not within so many seconds.
        """
        if not self.__wait_for(lambda _event: True, process, cmd_args, timeout):
            raise AssertionError(f"Timed out waiting for process '{process}' to start")

    def __wait_for(
        self,
        holds: Callable[[_Event], bool],
        process: ExecuteLocal | str,
        cmd_args: object,
        timeout: float | None,
    ) -> bool:
        def has_happened() -> bool:
            events = self._proc_info_handler
            try:
                (action,) = resolveProcesses(events, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return holds(events[action])

        with self._changed:
            return self._changed.wait_for(has_happened, timeout=timeout)


def _has_ended(event: _Event) -> bool:
    return isinstance(event, ProcessExited)
