# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Runs launch descriptions."""

from __future__ import annotations

import asyncio
import atexit
from collections.abc import Coroutine, Iterable
import contextlib
import logging
import signal
import threading
import traceback
from typing import Any
import warnings

from .event import Event
from .event_handler import BaseEventHandler
from .event_handlers import OnIncludeLaunchDescription, OnShutdown
from .events import IncludeLaunchDescription, Shutdown
from .events.process import ShutdownProcess
from .events.shutdown import Interrupted
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .logging import get_logger, launch_config, log_launch_config
from .source_location import describe_error
from .utilities import (
    AsyncSafeSignalManager,
    normalize_to_list_of_entities,
    visit_all_entities_and_collect_futures,
)


class LaunchService:
    """Visits launch descriptions and processes events until nothing is left to do.

    :param argv: for access by the entities.
    :param noninteractive: no user at a terminal: SIGINT is sent on to the children.
    :param debug: log tracebacks and debug messages.
    """

    def __init__(
        self,
        *,
        argv: Iterable[str] | None = None,
        noninteractive: bool = False,
        debug: bool = False,
    ) -> None:
        launch_config.level = logging.DEBUG if debug else logging.INFO
        self.__debug = debug
        self.__logger = get_logger('launch')
        self.__context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.context.register_event_handler(OnIncludeLaunchDescription())
        self.context.register_event_handler(OnShutdown(on_shutdown=self.__on_shutdown))
        self.__futures: list[asyncio.Future[None]] = []
        self.__lock = threading.RLock()
        self.__loop: asyncio.AbstractEventLoop | None = None
        self.__task: asyncio.Task[Any] | None = None
        self.__wakeup: asyncio.Event | None = None
        self.__shutting_down = False
        self.__shutdown_when_idle = True
        self.__sigint_received = False
        self.__return_code = 0

    @property
    def context(self) -> LaunchContext:
        return self.__context

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop the service runs in, None while it does not run."""
        return self.__loop

    @property
    def task(self) -> asyncio.Task[Any] | None:
        """The task that the service runs in or ran in last, None before."""
        return self.__task

    # ---- from any thread ----

    def emit_event(self, event: Event) -> None:
        """Emit an event, from any thread; where the service does not run, for when it does."""
        with self.__lock:
            if self.__loop is None:
                self.context.emit_event_sync(event)
            else:
                self.__loop.call_soon_threadsafe(self.context.emit_event_sync, event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Visit a launch description; from any thread, before or while the service runs."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def shutdown(self, force_sync: bool = False) -> Coroutine[Any, Any, None] | None:
        """End everything, so that run() returns; from any thread.

        Does nothing where the service does not run.

        :return: in the thread of the service, unless ``force_sync``, something to await.
        """
        event = Shutdown(reason='LaunchService.shutdown() called')
        with self.__lock:
            if self.__loop is None:
                return None
            if threading.current_thread() is not threading.main_thread():
                self.__loop.call_soon_threadsafe(self.__begin_shutdown, event)
                return None
        self.__begin_shutdown(event)
        return None if force_sync else _nothing_left_to_do()

    # ---- running ----

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until everything has ended, in the event loop of the main thread.

        Handles SIGINT, SIGTERM, SIGQUIT and SIGHUP.

        :param shutdown_when_idle: end as soon as nothing runs and no event is left.
        :return: 0, or 1 where launching failed.
        :raises RuntimeError: this is not the main thread.
        """
        loop = _loop_of_main_thread()
        task = loop.create_task(self.run_async(shutdown_when_idle=shutdown_when_idle))
        try:
            return loop.run_until_complete(task)
        except KeyboardInterrupt:  # came while the service did not handle signals
            task.cancel()
            loop.run_until_complete(asyncio.wait([task]))
            raise

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run in the loop of the caller; see :meth:`run`."""
        if threading.current_thread() is not threading.main_thread():
            raise RuntimeError('LaunchService can only be run in the main thread.')
        with self.__lock:
            if self.__loop is not None:
                raise RuntimeError('LaunchService cannot be run multiple times concurrently.')
            self.__loop = asyncio.get_running_loop()
        self.__task = asyncio.current_task()
        if self.__debug:
            self.__loop.set_debug(True)
        log_launch_config(logger=self.__logger)
        self.__wakeup = asyncio.Event()
        self.__shutdown_when_idle = shutdown_when_idle
        self.__shutting_down = self.__sigint_received = False
        self.__return_code = 0
        self.context._set_is_shutdown(False)
        self.context._set_asyncio_loop(self.__loop)
        self.context._wake = self.__wakeup.set
        loop, handler_before = self.__loop, self.__loop.get_exception_handler()
        loop.set_exception_handler(self.__on_error_in_loop)
        try:
            with self.__signals(loop):
                await self.__run_to_the_end()
        finally:
            loop.set_exception_handler(handler_before)
            with self.__lock:
                self.__loop = None
                self.context._wake = None
                self.context._set_asyncio_loop(None)
        return self.__return_code

    def __on_error_in_loop(self, loop: asyncio.AbstractEventLoop, what: dict[str, Any]) -> None:
        """Let the launch fail for an error in a task or callback that nobody awaits."""
        self.__return_code = 1
        loop.default_exception_handler(what)

    async def __run_to_the_end(self) -> None:
        while True:
            try:
                await self.__run_loop()
            except asyncio.CancelledError:
                self.__logger.error('run task was canceled')
                self.__return_code = 1
                self.__begin_shutdown(Shutdown(reason='the launch was cancelled'))
            except Exception as error:
                text = 'Caught exception in launch (see debug for traceback): '
                self.__logger.debug(traceback.format_exc())
                self.__logger.error(text + describe_error(error))
                self.__return_code = 1
                self.__begin_shutdown(Shutdown(reason=text + str(error)))
            else:
                return

    async def __run_loop(self) -> None:
        """Process events and wait for what is under way; return when all has ended."""
        assert self.__wakeup is not None
        while True:
            self.__wakeup.clear()
            while not self.context._event_queue.empty():
                self.__process_event(self.context._event_queue.get_nowait())
                await asyncio.sleep(0)
            if self._is_idle():
                if self.__shutting_down:
                    return
                if self.__shutdown_when_idle:
                    self.__begin_shutdown(Shutdown(reason='idle'))
                    continue
            await self.__wakeup.wait()

    def _is_idle(self) -> bool:
        """Return whether nothing is under way; raise what went wrong in what is done."""
        self.__watch(self.context._completion_futures)
        self.context._completion_futures.clear()
        done = [future for future in self.__futures if future.done()]
        self.__futures = [future for future in self.__futures if not future.done()]
        for future in done:
            if not future.cancelled() and future.exception() is not None:
                raise future.exception()  # type: ignore[misc]
        return not self.__futures and self.context._event_queue.empty()

    def __watch(self, futures: Iterable[asyncio.Future[None]]) -> None:
        for future in futures:
            self.__futures.append(future)
            future.add_done_callback(self.__wake)

    def __wake(self, _future: asyncio.Future[None]) -> None:
        if self.__wakeup is not None:
            self.__wakeup.set()

    def __process_event(self, event: Event) -> None:
        """Let every handler have the event, and raise the first error then.

        What goes wrong in one handler does not keep the others from ending their processes.
        """
        self.__logger.debug(f"processing event: '{event}'")
        first_error: Exception | None = None
        for handler in tuple(self.context._event_handlers):
            try:
                if handler.matches(event):
                    self.__handle(event, handler)
            except Exception as error:
                first_error = first_error or error
        if first_error is not None:
            raise first_error

    def __handle(self, event: Event, handler: BaseEventHandler) -> None:
        self.context._push_locals()
        try:
            self.__visit(handler.handle(event, self.context))
        finally:
            self.context._pop_locals()

    def __visit(self, entities: Any) -> None:
        if entities is None:
            return
        if isinstance(entities, LaunchDescriptionEntity):
            entities = [entities]
        known = [entity for entity in entities if entity is not None]
        for entity in normalize_to_list_of_entities(known):
            pairs = visit_all_entities_and_collect_futures(entity, self.context)
            self.__watch(future for _, future in pairs)

    # ---- the end ----

    def __on_shutdown(self, event: Event, context: LaunchContext) -> None:
        del event, context
        self.__shutting_down = True
        self.context._set_is_shutdown(True)

    def __begin_shutdown(self, event: Shutdown) -> None:
        if not self.__shutting_down:
            self.context.emit_event_sync(event)
        self.__shutting_down = True
        self.context._set_is_shutdown(True)

    def __on_sigint(self, _number: int) -> None:
        text = 'user interrupted with ctrl-c (SIGINT)'
        if self.__sigint_received:
            self.__logger.warning(f'{text} again, ignoring...')
            return
        self.__sigint_received = True
        self.__logger.warning(text)
        self.__begin_shutdown(Interrupted())

    def __on_termination(self, number: int) -> None:
        """End the children before the launch; upstream leaves them running."""
        name = signal.Signals(number).name
        self.__logger.warning(f'received {name}: shutting down launched system')
        if self.__shutting_down:  # then only what OnShutdown has started is not being ended yet
            self.context.emit_event_sync(ShutdownProcess(process_matcher=lambda _: True))
        self.__begin_shutdown(Shutdown(reason=name))

    def __signals(self, loop: asyncio.AbstractEventLoop) -> AsyncSafeSignalManager:
        manager = AsyncSafeSignalManager(loop)
        manager.handle(signal.SIGINT, self.__on_sigint)
        manager.handle(signal.SIGTERM, self.__on_termination)
        manager.handle(signal.SIGQUIT, self.__on_termination)
        # A terminal that is closed sends it; nohup has it ignored. Upstream ends at once, and
        # leaves its temporary files and each child that takes no notice of it.
        if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
            manager.handle(signal.SIGHUP, self.__on_termination)
        return manager


async def _nothing_left_to_do() -> None:
    """Do nothing: what upstream does here as late as this is awaited has been done."""


_last_loop: asyncio.AbstractEventLoop | None = None


def _loop_of_main_thread() -> asyncio.AbstractEventLoop:
    """Return the event loop that is set, or else set one; it is closed at exit."""
    global _last_loop  # noqa: PLW0603 -- as asyncio keeps the one of a thread
    loop = _last_loop
    with warnings.catch_warnings(), contextlib.suppress(RuntimeError):
        warnings.simplefilter('ignore', DeprecationWarning)  # not the same in any two Pythons
        loop = asyncio.get_event_loop()
    if loop is None or loop.is_closed():
        loop = asyncio.new_event_loop()
    if loop is not _last_loop:
        atexit.register(loop.close)
    asyncio.set_event_loop(loop)
    _last_loop = loop
    return loop
