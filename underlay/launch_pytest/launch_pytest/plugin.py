# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let pytest run tests with the mark launch beside a launch, or when it has ended.

Every run of pytest loads this: launch is imported with the first launch.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
import functools
import inspect
from typing import Any, TYPE_CHECKING

from launch_testing.pytest.hooks import forget_removed_modules
import pytest

import launch_pytest

from .fixture import (
    finalize_launch_service,
    get_event_loop_fixture,
    get_launch_context_fixture,
    get_launch_service_fixture,
    launch_fixture_of,
    LaunchFixture,
)
from .running import LaunchTest, run_launch_test

if TYPE_CHECKING:
    from launch import LaunchDescription
    from launch_testing.actions import ReadyToTest

_TEST = pytest.StashKey[LaunchTest]()

launch_service = get_launch_service_fixture(overridable=False)
launch_context = get_launch_context_fixture(overridable=False)
event_loop = get_event_loop_fixture(overridable=False)


class LaunchTestWarning(pytest.PytestWarning):
    """A test with the mark launch cannot be run."""


def pytest_configure(config: pytest.Config) -> None:
    forget_removed_modules(launch_pytest)
    config.addinivalue_line(
        'markers',
        'launch(fixture, shutdown=False): run the test beside the launch of a fixture, or with '
        'shutdown=True when it has ended',
    )


# ---- launches ----


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_fixture_setup(fixturedef: Any, request: Any) -> Generator[None, Any, Any]:
    """Start the launch that a fixture has described."""
    launch = launch_fixture_of(fixturedef.func)
    if launch is None:
        return (yield)
    # Before the fixture, for they are to be torn down after it.
    service = request.getfixturevalue('launch_service')
    loop = request.getfixturevalue('event_loop')
    result = yield
    prefix = f"When running launch_pytest fixture '{launch.name}':"
    try:
        description = _description_in(result, prefix)
        ready = _ready_action(description)
        fixturedef.addfinalizer(
            functools.partial(finalize_launch_service, service, prefix, launch.auto_shutdown)
        )
        _start(service, loop, description, ready, launch.shutdown_when_idle, prefix)
    except BaseException:
        # Let the next test with it try again, instead of having a launch that does not run.
        fixturedef.cached_result = None
        raise
    return result


def _description_in(result: Any, prefix: str) -> LaunchDescription:
    from launch import LaunchDescription

    first = result[0] if isinstance(result, Sequence) and result else result
    if not isinstance(first, LaunchDescription):
        raise TypeError(
            f'{prefix} return value must be either a launch description or a sequence which '
            f'first item is a launch description, not {result!r}'
        )
    return first


def _ready_action(description: LaunchDescription) -> ReadyToTest:
    """Return the ReadyToTest of a description, which gets one where it has none."""
    from launch_testing.actions.ready import find_ready_to_test, ReadyToTest

    actions = list(find_ready_to_test(description.entities))
    if len(actions) > 1:
        raise ValueError(
            'launch_pytest fixtures must return a LaunchDescription containing only one '
            'ReadyToTest action'
        )
    if not actions:
        actions = [ReadyToTest()]
        description.add_action(actions[0])
    return actions[0]


def _start(
    service: Any,
    loop: Any,
    description: LaunchDescription,
    ready: ReadyToTest,
    shutdown_when_idle: bool,
    prefix: str,
) -> None:
    """Start a launch and wait until it is ready; it goes on whenever the loop runs."""
    import asyncio

    is_ready = loop.create_future()
    ready._add_callback(lambda: is_ready.done() or is_ready.set_result(None))
    service.include_launch_description(description)
    task = loop.create_task(service.run_async(shutdown_when_idle=shutdown_when_idle))
    loop.run_until_complete(asyncio.wait({task, is_ready}, return_when=asyncio.FIRST_COMPLETED))
    if not is_ready.done():
        raise RuntimeError(f'{prefix} the launch ended before it came to ReadyToTest')


# ---- tests ----


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: Any) -> list[Any] | None:
    """Collect functions, coroutines and generators with the mark launch."""
    if not inspect.isfunction(obj) or hasattr(obj, '_launch_pytest_collected'):
        return None
    marks = [mark for mark in getattr(obj, 'pytestmark', ()) if mark.name == 'launch']
    mark = marks[0] if marks else collector.get_closest_marker('launch')
    if mark is None:
        return None
    if mark.kwargs.get('fixture') is None:
        return _skipped(_collect(collector, name, obj))
    launch = launch_fixture_of(mark.kwargs['fixture'])
    if launch is None:
        raise collector.CollectError(
            f'{name}: the fixture of @pytest.mark.launch must be one of @launch_pytest.fixture, '
            f'not {mark.kwargs["fixture"]!r}'
        )
    shutdown = bool(mark.kwargs.get('shutdown', False))
    items = _collect(collector, name, obj, launch)
    for item in items:
        item.stash[_TEST] = LaunchTest(launch=launch, after_shutdown=shutdown)
    if items and _has_halves(obj) and not shutdown and launch.scope != 'function':
        items += _second_halves(items, _collect(collector, name, obj, launch))
    return items or None


def _has_halves(function: Callable[..., Any]) -> bool:
    return inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function)


def _collect(
    collector: Any, name: str, function: Callable[..., Any], launch: LaunchFixture | None = None
) -> list[Any]:
    """Return pytest's items of a test as if it were a plain function with its launch."""

    @functools.wraps(function)
    def plain() -> None:
        raise NotImplementedError('pytest_pyfunc_call runs the test')

    plain._launch_pytest_collected = True  # type: ignore[attr-defined]
    if launch is not None:
        pytest.mark.usefixtures(launch.name, 'launch_service', 'event_loop')(plain)
    items = collector.ihook.pytest_pycollect_makeitem(collector=collector, name=name, obj=plain)
    return list(items or ())


def _skipped(items: Iterable[Any]) -> list[Any]:
    reason = '"fixture" keyword argument is required in a pytest.mark.launch() decorator'
    for item in items:
        item.warn(LaunchTestWarning(reason))
        item.add_marker(pytest.mark.skip(reason))
    return list(items)


def _second_halves(items: Iterable[Any], second_items: Iterable[Any]) -> list[Any]:
    """Make items what runs after the yield of others, when the launch has ended."""
    for item, second in zip(items, second_items, strict=True):
        second.name = f'{second.name}[shutdown_test]'
        second.stash[_TEST] = item.stash[_TEST].second_half()
    return list(second_items)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Move tests of a launch that has ended behind those that run beside it."""
    last = {_launch_of(item): item for item in items if _is_beside(item)}
    waiting: dict[Any, list[pytest.Item]] = {}
    ordered: list[pytest.Item] = []
    for item in items:
        launch = _launch_of(item)
        if launch in last and not _is_beside(item):
            waiting.setdefault(launch, []).append(item)
            continue
        ordered.append(item)
        if last.get(launch) is item:
            ordered += waiting.pop(launch, [])
            del last[launch]
    items[:] = ordered


def _launch_of(item: pytest.Item) -> tuple[Any, ...] | None:
    """Return what is the same for all tests of a launch; None where no other has the launch."""
    test = item.stash.get(_TEST, None)
    if test is None or test.launch.scope == 'function':
        return None
    kind = {'class': pytest.Class, 'module': pytest.Module}.get(test.launch.scope, pytest.Session)
    indices = item.callspec.indices if hasattr(item, 'callspec') else {}
    return test.launch, item.getparent(kind), indices.get(test.launch.name, 0)


def _is_beside(item: pytest.Item) -> bool:
    return _launch_of(item) is not None and not item.stash[_TEST].after_shutdown


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    test = pyfuncitem.stash.get(_TEST, None)
    if test is None:
        return None
    given: dict[str, Any] = pyfuncitem.funcargs
    parameters = inspect.signature(pyfuncitem.obj).parameters.values()
    arguments = {
        each.name: given[each.name]
        for each in parameters
        if each.name in given and each.default is each.empty
    }
    end_launch = functools.partial(
        finalize_launch_service,
        given['launch_service'],
        f'When running test {pyfuncitem.name}',
        test.launch.auto_shutdown,
    )
    run_launch_test(test, pyfuncitem.obj, arguments, given['event_loop'], end_launch)
    return True
