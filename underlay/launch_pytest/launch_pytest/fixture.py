# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of pytest that are launches, and what these run in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
import sys
from typing import Any, TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    import asyncio

    from launch import LaunchContext, LaunchService

_SCOPES = ('function', 'class', 'module', 'package', 'session')


@dataclass(frozen=True, kw_only=True, eq=False)
class LaunchFixture:
    """What a fixture made by :func:`fixture` is."""

    name: str
    scope: str
    shutdown_when_idle: bool
    auto_shutdown: bool


def fixture(
    decorated: Callable[..., Any] | None = None,
    *args: Any,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Make a function a fixture whose launch runs while the tests with it do.

    It returns a LaunchDescription, or a sequence of which the first is one. The other arguments
    are those of pytest.fixture. With a scope other than 'function' the fixtures launch_service,
    launch_context and event_loop have this scope in the whole module.

    :param shutdown_when_idle: end the launch as soon as nothing runs.
    :param auto_shutdown: end it when the tests that run beside it have run; else it must end by
        itself.
    """
    scope = kwargs.get('scope', 'function')
    if scope != 'function':
        _widen(sys._getframe(1).f_globals, scope)

    def decorate(function: Callable[..., Any]) -> Any:
        function._launch_pytest = LaunchFixture(  # type: ignore[attr-defined]
            name=kwargs.get('name') or function.__name__,
            scope=scope,
            shutdown_when_idle=shutdown_when_idle,
            auto_shutdown=auto_shutdown,
        )
        return pytest.fixture(*args, **kwargs)(function)

    return decorate if decorated is None else decorate(decorated)


def launch_fixture_of(fixture_function: object) -> LaunchFixture | None:
    """Return what :func:`fixture` has made, None for everything else."""
    return getattr(fixture_function, '_launch_pytest', None)


def _widen(module: dict[str, Any], scope: str) -> None:
    """Give a module the fixtures that its launches run in, where it has none so wide."""
    for name, make in _ENVIRONMENT.items():
        known = module.get(name)
        own_scope = getattr(known, '_launch_pytest_scope', None)
        if known is None or (own_scope and _SCOPES.index(own_scope) < _SCOPES.index(scope)):
            module[name] = make(scope=scope)


def finalize_launch_service(
    launch_service: LaunchService, eprefix: str = '', auto_shutdown: bool = True
) -> None:
    """Let a launch come to its end, if it has not; not from within its loop.

    :param auto_shutdown: shut it down first.
    :raises AssertionError: it has failed.
    """
    if auto_shutdown:
        launch_service.shutdown(force_sync=True)
    loop = launch_service.event_loop
    if loop is not None and not loop.is_closed():
        assert launch_service.task is not None
        code = loop.run_until_complete(launch_service.task)
        if code != 0:
            raise AssertionError(
                f"{eprefix} launch service failed when finishing, return code '{code}'"
            )


def get_launch_service_fixture(*, scope: Any = 'function', overridable: bool = True) -> Any:
    """Return the fixture launch_service: the service that runs the launch.

    :param overridable: a launch fixture of a wider scope may replace it.
    """

    def launch_service(event_loop: asyncio.AbstractEventLoop) -> Iterator[LaunchService]:  # noqa: ARG001 -- to be closed after it
        """Return the service that runs the launch."""
        from launch import LaunchService

        service = LaunchService()
        yield service
        finalize_launch_service(service, eprefix='When tearing down launch_service fixture')

    return _make(launch_service, scope, overridable)


def get_launch_context_fixture(*, scope: Any = 'function', overridable: bool = True) -> Any:
    """Return the fixture launch_context: the context of the launch."""

    def launch_context(launch_service: LaunchService) -> LaunchContext:
        """Return the context of the launch."""
        return launch_service.context

    return _make(launch_context, scope, overridable)


def get_event_loop_fixture(*, scope: Any = 'function', overridable: bool = True) -> Any:
    """Return the fixture event_loop: the loop of the launch and of tests that are coroutines."""

    def event_loop() -> Iterator[asyncio.AbstractEventLoop]:
        """Return the loop of the launch and of tests that are coroutines."""
        import asyncio

        loop = asyncio.new_event_loop()
        yield loop
        loop.close()

    return _make(event_loop, scope, overridable)


def _make(function: Callable[..., Any], scope: Any, overridable: bool) -> Any:
    if overridable:
        function._launch_pytest_scope = scope  # type: ignore[attr-defined]
    return pytest.fixture(scope=scope)(function)


_ENVIRONMENT: dict[str, Callable[..., Any]] = {
    'launch_service': get_launch_service_fixture,
    'launch_context': get_launch_context_fixture,
    'event_loop': get_event_loop_fixture,
}
