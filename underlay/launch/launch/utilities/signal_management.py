# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Signals that are handled in an event loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import signal
import threading
from types import TracebackType
from typing import Any, ClassVar

_Handler = Callable[[int], Any]


class AsyncSafeSignalManager:
    """Calls handlers of signals in an event loop while it is entered; in the main thread only.

    May be entered again, and inside of another one: then both get the signal. What handled the
    signals before does so again afterwards.
    """

    __innermost: ClassVar[AsyncSafeSignalManager | None] = None

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.__loop = loop
        self.__handlers: dict[signal.Signals, _Handler] = {}
        self.__before: dict[signal.Signals, Any] = {}
        self.__outer: AsyncSafeSignalManager | None = None
        self.__entered = False

    def __enter__(self) -> AsyncSafeSignalManager:
        """Begin to handle the signals.

        :raises ValueError: this is not the main thread.
        """
        if threading.current_thread() is not threading.main_thread():
            raise ValueError('signals are handled in the main thread only')
        self.__outer = AsyncSafeSignalManager.__innermost
        # One loop at a time is woken by signals: this one gets those of the outer one too.
        for number in {*self.__handlers, *(self.__outer.__before if self.__outer else ())}:
            self.__install(number)
        AsyncSafeSignalManager.__innermost = self
        self.__entered = True
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc_value: BaseException | None,
        exc_traceback: TracebackType | None,
    ) -> None:
        self.__entered = False
        AsyncSafeSignalManager.__innermost = self.__outer
        while self.__before:
            self.__uninstall(*self.__before.popitem())
        self.__outer = None

    def handle(self, signum: signal.Signals | int, handler: _Handler | None) -> _Handler | None:
        """Set the handler of a signal, None for none; return the one before.

        :raises ValueError: there is no such signal, or the handler cannot be called.
        """
        number = signal.Signals(signum)
        if handler is not None and not callable(handler):
            raise ValueError(f'signal handler {handler!r} is not callable')
        before = self.__handlers.pop(number, None)
        if handler is not None:
            self.__handlers[number] = handler
            if self.__entered:
                self.__install(number)
        elif number in self.__before:
            self.__uninstall(number, self.__before.pop(number))
        return before

    def __install(self, number: signal.Signals) -> None:
        if number not in self.__before:
            before = signal.getsignal(number)
            self.__loop.add_signal_handler(number, self.__call_handlers, number)
            self.__before[number] = before

    def __uninstall(self, number: signal.Signals, before: Any) -> None:
        self.__loop.remove_signal_handler(number)
        if self.__outer is not None and number in self.__outer.__before:
            self.__outer.__loop.add_signal_handler(number, self.__outer.__call_handlers, number)
        else:
            signal.signal(number, before)

    def __call_handlers(self, number: signal.Signals) -> None:
        if handler := self.__handlers.get(number):
            handler(number)
        if self.__outer is not None:
            self.__outer.__loop.call_soon_threadsafe(self.__outer.__call_handlers, number)
