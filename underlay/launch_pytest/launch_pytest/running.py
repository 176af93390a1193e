# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run one test of a launch: the loop, and with it the launch, runs as long as the test does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
import functools
import inspect
from typing import Any, TYPE_CHECKING

import pytest

from .fixture import LaunchFixture

if TYPE_CHECKING:
    import asyncio

_ENDED = object()


@dataclass(frozen=True, kw_only=True)
class LaunchTest:
    """How a test is run.

    :param started: what a generator's first half leaves to its second half.
    """

    launch: LaunchFixture
    after_shutdown: bool
    is_second_half: bool = False
    started: list[Any] = field(default_factory=list)

    def second_half(self) -> LaunchTest:
        """Return how what comes after the yield of this test is run."""
        return replace(self, after_shutdown=True, is_second_half=True)


def run_launch_test(
    test: LaunchTest,
    function: Callable[..., Any],
    arguments: dict[str, Any],
    loop: asyncio.AbstractEventLoop,
    end_launch: Callable[[], None],
) -> None:
    """Run a function, coroutine or generator; functions in a thread, for the loop has this one."""
    is_generator = inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function)
    if is_generator and test.after_shutdown and not test.is_second_half:
        pytest.fail(
            'generator or async generator based launch test items cannot be marked with '
            'shutdown=True',
            pytrace=False,
        )
    if is_generator:
        if not test.is_second_half:
            generator = function(**arguments)
            _run_to_yield(generator, loop)
            test.started.append(generator)
        if test.is_second_half or test.launch.scope == 'function':
            if not test.started:
                pytest.skip('the test failed before the launch was shut down')
            end_launch()
            _run_to_end(test.started.pop(), loop)
        return
    if test.after_shutdown:
        end_launch()
    if inspect.iscoroutinefunction(function):
        loop.run_until_complete(function(**arguments))
    else:
        loop.run_until_complete(
            loop.run_in_executor(None, functools.partial(function, **arguments))
        )


def _run_to_yield(generator: Any, loop: asyncio.AbstractEventLoop) -> None:
    if _step(generator, loop) is _ENDED:
        pytest.fail('launch tests that are generators must yield once', pytrace=False)


def _run_to_end(generator: Any, loop: asyncio.AbstractEventLoop) -> None:
    if _step(generator, loop) is not _ENDED:
        pytest.fail(
            'launch tests that are generators must stop iteration after yielding once',
            pytrace=False,
        )


def _step(generator: Any, loop: asyncio.AbstractEventLoop) -> Any:
    """Run a generator of either kind to its next yield; return _ENDED where there is none."""
    if inspect.isasyncgen(generator):
        return loop.run_until_complete(_step_async(generator))
    return loop.run_until_complete(loop.run_in_executor(None, next, generator, _ENDED))


async def _step_async(generator: Any) -> Any:
    return await anext(generator, _ENDED)
