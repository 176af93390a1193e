# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The state of a launch: configurations, environment, locals, event handlers."""

from __future__ import annotations

import asyncio
import collections
from collections.abc import Callable, Iterable, Mapping, MutableMapping
import os
from typing import Any, TYPE_CHECKING

from .event import Event
from .substitution import Substitution

if TYPE_CHECKING:
    from .event_handler import BaseEventHandler


class _Locals:
    """The globals and locals of a context as attributes."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        known = ', '.join(self.__dict__)
        raise AttributeError(
            f"context.locals does not contain attribute '{name}', it contains: [{known}]"
        )

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"can't set attribute '{name}', locals are read-only")


class LaunchContext:
    """What substitutions and actions see of the launch that runs them.

    :param argv: for access by the entities.
    :param noninteractive: no user at a terminal, so that Ctrl-C does not reach the children by
        itself.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or [])
        self.noninteractive = noninteractive
        self._event_queue: asyncio.Queue[Event] = asyncio.Queue()
        self._event_handlers: collections.deque[BaseEventHandler] = collections.deque()
        self._completion_futures: list[asyncio.Future[None]] = []
        self._wake: Callable[[], None] | None = None
        self.__globals: dict[str, Any] = {}
        self.__locals: dict[str, Any] = {}
        self.__locals_stack: list[dict[str, Any]] = []
        self.__launch_configurations: dict[str, Any] = {}
        self.__configurations_stack: list[dict[str, Any]] = []
        self.__environment_stack: list[dict[str, str]] = []
        self.__environment_at_start = dict(os.environ)
        self.__is_shutdown = False
        self.__asyncio_loop: asyncio.AbstractEventLoop | None = None

    def _set_is_shutdown(self, state: bool) -> None:
        self.__is_shutdown = state

    @property
    def is_shutdown(self) -> bool:
        return self.__is_shutdown

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self.__asyncio_loop = loop

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop of the running launch, None while it does not run."""
        return self.__asyncio_loop

    def add_completion_future(self, future: asyncio.Future[None]) -> None:
        """Keep the launch from being idle until the future is done."""
        self._completion_futures.append(future)

    # ---- globals and locals ----

    def extend_globals(self, extensions: Mapping[str, Any]) -> None:
        self.__globals.update(extensions)

    def _get_globals(self) -> dict[str, Any]:
        return dict(self.__globals)

    def get_locals_as_dict(self) -> dict[str, Any]:
        return {**self.__globals, **self.__locals}

    @property
    def locals(self) -> _Locals:
        return _Locals(self.get_locals_as_dict())

    def extend_locals(self, extensions: Mapping[str, Any]) -> None:
        self.__locals.update(extensions)

    def _push_locals(self) -> None:
        self.__locals_stack.append(dict(self.__locals))

    def _pop_locals(self) -> None:
        if not self.__locals_stack:
            raise RuntimeError('locals stack unexpectedly empty')
        self.__locals = self.__locals_stack.pop()

    # ---- launch configurations and environment ----

    @property
    def launch_configurations(self) -> dict[str, Any]:
        return self.__launch_configurations

    def _push_launch_configurations(self) -> None:
        self.__configurations_stack.append(dict(self.__launch_configurations))

    def _pop_launch_configurations(self) -> None:
        if not self.__configurations_stack:
            raise RuntimeError('launch configurations stack unexpectedly empty')
        self.__launch_configurations = self.__configurations_stack.pop()

    @property
    def environment(self) -> MutableMapping[str, str]:
        """The environment that substitutions read and processes start with."""
        return os.environ

    def _push_environment(self) -> None:
        self.__environment_stack.append(dict(os.environ))

    def _pop_environment(self) -> None:
        if not self.__environment_stack:
            raise RuntimeError('environment stack unexpectedly empty')
        self._set_environment(self.__environment_stack.pop())

    def _reset_environment(self) -> None:
        """Go back to the environment that the launch began with."""
        self._set_environment(self.__environment_at_start)

    @staticmethod
    def _set_environment(wanted: Mapping[str, str]) -> None:
        for name in set(os.environ) - set(wanted):
            del os.environ[name]
        os.environ.update(wanted)

    # ---- events ----

    def would_handle_event(self, event: Event) -> bool:
        return any(handler.matches(event) for handler in self._event_handlers)

    def register_event_handler(
        self, event_handler: BaseEventHandler, append: bool = False
    ) -> None:
        """Add a handler, before the others unless ``append``."""
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: BaseEventHandler) -> None:
        """Take a handler away.

        :raises ValueError: it is not registered.
        """
        self._event_handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        """Queue an event; call it from the thread of the launch only."""
        self._event_queue.put_nowait(event)
        if self._wake is not None:
            self._wake()

    async def emit_event(self, event: Event) -> None:
        self.emit_event_sync(event)

    def perform_substitution(self, substitution: Substitution) -> str:
        return substitution.perform(self)
