# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Wait until a process has started, has ended, or has written something.

Each function takes the context of the launch, the action of the process and a timeout in seconds,
None for no end. Those with _sync block: they are for tests that are plain functions or generators.
The process must cache its output (cached_output=True) where output is waited for.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
import contextlib
import threading
import time
from typing import TypeVar

from launch import LaunchContext
from launch.actions import ExecuteLocal
from launch.event_handler import BaseEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart

_Result = TypeVar('_Result')
# Of a function to call: the handler that calls it at an event.
_HandlerOf = Callable[[Callable[[], None]], BaseEventHandler]
_Validate = Callable[[str], object]


async def wait_for_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Callable[[str], _Result],
    timeout: float | None = None,
) -> _Result:
    """Wait until the standard output is such; return what the function says of it at last."""
    return await _wait(
        launch_context,
        _stdout_of(execute_process_action),
        lambda: validate_output(execute_process_action.get_stdout()),
        timeout,
    )


def wait_for_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Callable[[str], _Result],
    timeout: float | None = None,
) -> _Result:
    """Wait as wait_for_output does."""
    return _wait_sync(
        launch_context,
        _stdout_of(execute_process_action),
        lambda: validate_output(execute_process_action.get_stdout()),
        timeout,
    )


async def assert_output(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: _Validate,
    timeout: float | None = None,
) -> None:
    """Wait until a function of the standard output asserts nothing more; else let it raise."""
    holds = _asserts_nothing(validate_output)
    if not await wait_for_output(launch_context, execute_process_action, holds, timeout):
        validate_output(execute_process_action.get_stdout())


def assert_output_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: _Validate,
    timeout: float | None = None,
) -> None:
    """Wait as assert_output does."""
    holds = _asserts_nothing(validate_output)
    if not wait_for_output_sync(launch_context, execute_process_action, holds, timeout):
        validate_output(execute_process_action.get_stdout())


async def wait_for_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Callable[[str], _Result],
    timeout: float | None = None,
) -> _Result:
    """Wait until the standard error is such; return what the function says of it at last."""
    return await _wait(
        launch_context,
        _stderr_of(execute_process_action),
        lambda: validate_output(execute_process_action.get_stderr()),
        timeout,
    )


def wait_for_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: Callable[[str], _Result],
    timeout: float | None = None,
) -> _Result:
    """Wait as wait_for_stderr does."""
    return _wait_sync(
        launch_context,
        _stderr_of(execute_process_action),
        lambda: validate_output(execute_process_action.get_stderr()),
        timeout,
    )


async def assert_stderr(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: _Validate,
    timeout: float | None = None,
) -> None:
    """Wait until a function of the standard error asserts nothing more; else let it raise."""
    holds = _asserts_nothing(validate_output)
    if not await wait_for_stderr(launch_context, execute_process_action, holds, timeout):
        validate_output(execute_process_action.get_stderr())


def assert_stderr_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    validate_output: _Validate,
    timeout: float | None = None,
) -> None:
    """Wait as assert_stderr does."""
    holds = _asserts_nothing(validate_output)
    if not wait_for_stderr_sync(launch_context, execute_process_action, holds, timeout):
        validate_output(execute_process_action.get_stderr())


async def wait_for_start(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    timeout: float | None = None,
) -> bool:
    """Return whether the process has started within the time."""
    handler_of, holds = _start_of(execute_process_action)
    return await _wait(launch_context, handler_of, holds, timeout)


def wait_for_start_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    timeout: float | None = None,
) -> bool:
    """Return whether the process has started within the time."""
    handler_of, holds = _start_of(execute_process_action)
    return _wait_sync(launch_context, handler_of, holds, timeout)


async def wait_for_exit(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    timeout: float | None = None,
) -> bool:
    """Return whether the process has ended within the time."""
    handler_of, holds = _exit_of(execute_process_action)
    return await _wait(launch_context, handler_of, holds, timeout)


def wait_for_exit_sync(
    launch_context: LaunchContext,
    execute_process_action: ExecuteLocal,
    timeout: float | None = None,
) -> bool:
    """Return whether the process has ended within the time."""
    handler_of, holds = _exit_of(execute_process_action)
    return _wait_sync(launch_context, handler_of, holds, timeout)


def _stdout_of(action: ExecuteLocal) -> _HandlerOf:
    return lambda wake: OnProcessIO(target_action=action, on_stdout=lambda _event: wake())


def _stderr_of(action: ExecuteLocal) -> _HandlerOf:
    return lambda wake: OnProcessIO(target_action=action, on_stderr=lambda _event: wake())


def _start_of(action: ExecuteLocal) -> tuple[_HandlerOf, Callable[[], bool]]:
    return (
        lambda wake: OnProcessStart(
            target_action=action, on_start=lambda _event, _context: wake()
        ),
        lambda: 'pid' in (action.process_details or {}),
    )


def _exit_of(action: ExecuteLocal) -> tuple[_HandlerOf, Callable[[], bool]]:
    return (
        lambda wake: OnProcessExit(target_action=action, on_exit=lambda _event, _context: wake()),
        lambda: action.return_code is not None,
    )


def _asserts_nothing(validate: _Validate) -> Callable[[str], bool]:
    def holds(output: str) -> bool:
        try:
            validate(output)
        except AssertionError:
            return False
        return True

    return holds


@contextlib.contextmanager
def _registered(context: LaunchContext, handler: BaseEventHandler) -> Iterator[None]:
    context.register_event_handler(handler, append=True)
    try:
        yield
    finally:
        context.unregister_event_handler(handler)


async def _wait(
    context: LaunchContext,
    handler_of: _HandlerOf,
    condition: Callable[[], _Result],
    timeout: float | None,
) -> _Result:
    """Return the condition once it is true, or what it is when the time is over."""
    happened = asyncio.Event()
    left = _time_left(timeout)
    with _registered(context, handler_of(happened.set)):
        while not (result := condition()):
            try:
                await asyncio.wait_for(happened.wait(), left())
            except asyncio.TimeoutError:
                return result
            happened.clear()
    return result


def _wait_sync(
    context: LaunchContext,
    handler_of: _HandlerOf,
    condition: Callable[[], _Result],
    timeout: float | None,
) -> _Result:
    """Return the condition once it is true, or what it is when the time is over."""
    happened = threading.Event()
    left = _time_left(timeout)
    with _registered(context, handler_of(happened.set)):
        while not (result := condition()) and happened.wait(left()):
            happened.clear()
    return result


def _time_left(timeout_sec: float | None) -> Callable[[], float | None]:
    """Return a function that returns what is left of a time from now on."""
    if timeout_sec is None:
        return lambda: None
    deadline_sec = time.monotonic() + timeout_sec
    return lambda: max(0.0, deadline_sec - time.monotonic())
