# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The launch service: how it runs, fails and ends."""

import asyncio
import contextlib
import signal
from typing import Any

from launch import EventHandler, LaunchContext, LaunchDescription, LaunchService
from launch.actions import (
    ExecuteProcess,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.events import Shutdown as ShutdownEvent
from launch.utilities import AsyncSafeSignalManager
import psutil
import pytest

pytestmark = pytest.mark.usefixtures('launch_environment')


def _run(*actions: Any) -> int:
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription(actions))
    return service.run()


def test_an_error_in_a_handler_ends_the_launch_with_status_1(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def fail(_event: Any, _context: LaunchContext) -> None:
        raise RuntimeError('handler went wrong')

    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    status = _run(
        sleeper,
        ExecuteProcess(cmd=['true'], on_exit=fail),
    )
    assert status == 1
    assert sleeper.return_code == -2
    text = '[ERROR] [launch]: Caught exception in launch (see debug for traceback): '
    assert f'{text}handler went wrong' in capsys.readouterr().out


def _fail(_context: LaunchContext) -> None:
    raise RuntimeError('no such robot')


def _fail_at_the_end(event: Any, _context: LaunchContext | None = None) -> bool:
    if isinstance(event, ShutdownEvent):
        raise RuntimeError(f'cannot end: {event.reason}')
    return False


@pytest.mark.parametrize(
    'handler',
    [OnShutdown(on_shutdown=_fail_at_the_end), EventHandler(matcher=_fail_at_the_end)],  # type: ignore[arg-type]
    ids=['handler', 'matcher'],
)
def test_an_error_on_shutdown_leaves_no_process_behind(
    handler: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    status = _run(
        sleeper,
        TimerAction(period=0.1, actions=[Shutdown(reason='so')]),
        RegisterEventHandler(handler),
    )
    assert status == 1
    assert sleeper.return_code == -2
    assert 'cannot end: so' in capsys.readouterr().out


def test_an_error_in_a_callback_of_the_loop_is_status_1(
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail() -> None:
        raise RuntimeError('callback went wrong')

    def call_soon(context: LaunchContext) -> None:
        assert context.asyncio_loop is not None
        context.asyncio_loop.call_soon(fail)

    assert _run(OpaqueFunction(function=call_soon), ExecuteProcess(cmd=['true'])) == 1
    assert 'callback went wrong' in caplog.text
    assert _run(ExecuteProcess(cmd=['true'])) == 0
    assert asyncio.get_event_loop().get_exception_handler() is None


def test_what_on_shutdown_starts_runs_where_an_action_has_asked_for_the_end() -> None:
    def at_the_end(*before: Any) -> ExecuteProcess:
        last = ExecuteProcess(cmd=['echo', 'stopped the robot'], cached_output=True)
        _run(RegisterEventHandler(OnShutdown(on_shutdown=[last])), *before)
        return last

    assert at_the_end(Shutdown()).get_stdout() == 'stopped the robot\n'
    assert at_the_end().return_code is None  # as upstream: an idle launch has ended by then


def test_what_on_shutdown_starts_ends_with_sigterm() -> None:
    last = ExecuteProcess(cmd=['sleep', '30'])
    terminate = OpaqueFunction(function=lambda _: signal.raise_signal(signal.SIGTERM))
    _run(
        RegisterEventHandler(OnShutdown(on_shutdown=[last])),
        RegisterEventHandler(OnProcessStart(target_action=last, on_start=[terminate])),
        Shutdown(),
    )
    assert last.return_code == -signal.SIGINT


def test_a_launch_waits_for_futures_that_it_is_given(
    capsys: pytest.CaptureFixture[str],
) -> None:
    notes: list[str] = []

    async def note(fails: bool) -> None:
        await asyncio.sleep(0.05)
        notes.append('over')
        if fails:
            raise RuntimeError('the future went wrong')

    def add(context: LaunchContext, fails: bool) -> None:
        assert context.asyncio_loop is not None
        context.add_completion_future(context.asyncio_loop.create_task(note(fails)))

    assert [_run(OpaqueFunction(function=add, args=[fails])) for fails in (False, True)] == [0, 1]
    assert notes == ['over'] * 2
    failed = '[ERROR] [launch]: Caught exception in launch (see debug for traceback): '
    assert f'{failed}the future went wrong' in capsys.readouterr().out


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGQUIT])
def test_a_signal_that_terminates_ends_what_runs_first(
    number: signal.Signals, capsys: pytest.CaptureFixture[str]
) -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    terminate = OpaqueFunction(function=lambda _: signal.raise_signal(number))
    on_start = OnProcessStart(target_action=sleeper, on_start=[terminate])
    assert _run(RegisterEventHandler(on_start), sleeper) == 0
    assert sleeper.return_code == -signal.SIGINT
    told = f'[WARNING] [launch]: received {number.name}: shutting down launched system'
    assert told in capsys.readouterr().out.splitlines()


def test_what_ends_after_the_shutdown_starts_nothing() -> None:
    second = ExecuteProcess(cmd=['true'])
    first = ExecuteProcess(cmd=['sleep', '30'], on_exit=[second])
    assert _run(first, TimerAction(period=0.05, actions=[Shutdown()])) == 0
    assert (first.return_code, second.return_code) == (-signal.SIGINT, None)


def test_a_second_interrupt_is_ignored(capsys: pytest.CaptureFixture[str]) -> None:
    ends: list[str] = []

    def interrupt(_context: LaunchContext) -> None:
        for _ in range(3):
            signal.raise_signal(signal.SIGINT)

    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    _run(
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, _: ends.append(event.reason))),
        RegisterEventHandler(
            OnProcessStart(target_action=sleeper, on_start=[OpaqueFunction(function=interrupt)])
        ),
        sleeper,
    )
    assert ends == ['ctrl-c (SIGINT)']
    told = 'user interrupted with ctrl-c (SIGINT)'
    assert capsys.readouterr().out.count(f'{told} again, ignoring...') == 2


def test_an_error_starts_nothing_of_what_stands_before_it() -> None:
    assert _run(ExecuteProcess(cmd=['sleep', '31']), OpaqueFunction(function=_fail)) == 1
    children = psutil.Process().children()
    running = [each.cmdline() for each in children if each.status() != psutil.STATUS_ZOMBIE]
    assert ['sleep', '31'] not in running


def test_shutdown_may_come_from_another_thread() -> None:
    service = LaunchService(noninteractive=True)
    service.include_launch_description(
        LaunchDescription(
            [
                ExecuteProcess(cmd=['sleep', '30']),
                RegisterEventHandler(OnProcessExit(on_exit=[])),
            ]
        )
    )

    async def run() -> int:
        running = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0.2)
        await asyncio.to_thread(service.shutdown)
        return await asyncio.wait_for(running, 10.0)

    assert asyncio.run(run()) == 0


def test_shutdown_event_emitted_before_running_is_processed() -> None:
    service = LaunchService()
    service.emit_event(ShutdownEvent(reason='at once'))
    assert service.run(shutdown_when_idle=False) == 0


def test_a_service_can_run_again() -> None:
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription([OpaqueFunction(function=_fail)]))
    assert service.run() == 1
    for code in (3, 4):
        process = ExecuteProcess(cmd=['sh', '-c', f'exit {code}'])
        service.include_launch_description(LaunchDescription([process]))
        assert service.run() == 0
        assert process.return_code == code
        assert service.context.is_shutdown
        assert (service.event_loop, service.context.asyncio_loop) == (None, None)


def test_an_idle_service_waits_for_what_another_thread_includes() -> None:
    service = LaunchService(noninteractive=True)
    process = ExecuteProcess(cmd=['sh', '-c', 'exit 5'])

    async def run() -> int:
        running = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0.05)
        included = LaunchDescription([process])
        await asyncio.to_thread(service.include_launch_description, included)
        while process.return_code is None and not running.done():
            await asyncio.sleep(0.001)
        service.shutdown(force_sync=True)
        return await asyncio.wait_for(running, 10.0)

    assert asyncio.run(run()) == 0
    assert process.return_code == 5


def test_a_service_that_debugs_also_debugs_its_loop() -> None:
    debugs: list[bool] = []

    async def ask(service: LaunchService) -> int:
        status = await service.run_async()
        debugs.append(asyncio.get_running_loop().get_debug())
        return status

    for debug in (True, False):
        asyncio.run(ask(LaunchService(debug=debug)))
    assert debugs == [True, False]


def test_a_shutdown_from_inside_can_be_had_at_once() -> None:
    answers: list[Any] = []

    async def run(service: LaunchService) -> int:
        running = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0)
        answers.append(service.shutdown(force_sync=True))
        return await asyncio.wait_for(running, 10.0)

    assert asyncio.run(run(LaunchService(noninteractive=True))) == 0
    assert answers == [None]


def test_a_service_has_a_task_and_a_shutdown_to_await() -> None:
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription([ExecuteProcess(cmd=['sleep', '30'])]))
    assert service.task is None
    assert service.shutdown() is None

    async def run() -> int:
        running = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0.1)
        assert service.task is running
        ending = service.shutdown()
        assert ending is not None
        await asyncio.create_task(ending)
        return await asyncio.wait_for(running, 10.0)

    assert asyncio.run(run()) == 0


def test_a_cancelled_service_ends_its_processes_and_returns_1(
    capsys: pytest.CaptureFixture[str],
) -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription([sleeper]))

    async def run() -> int:
        running = asyncio.create_task(service.run_async())
        while 'pid' not in (sleeper.process_details or {}):
            await asyncio.sleep(0.001)
        running.cancel()
        return await asyncio.wait_for(running, 10.0)

    assert asyncio.run(run()) == 1
    assert sleeper.return_code == -2
    assert 'run task was canceled' in capsys.readouterr().out


def test_the_event_loop_of_a_run_stays_set() -> None:
    assert LaunchService().run() == 0
    loop = asyncio.get_event_loop()
    assert LaunchService().run() == 0
    assert asyncio.get_event_loop() is loop
    asyncio.run(asyncio.sleep(0.0))  # takes the loop that is set away
    assert LaunchService().run() == 0
    asyncio.get_event_loop().close()
    assert LaunchService().run() == 0


def test_signals_reach_every_manager_that_is_entered() -> None:
    seen: list[tuple[str, int]] = []
    before = signal.signal(signal.SIGUSR1, lambda *_: seen.append(('before', 0)))

    async def came(count: int) -> None:
        while len(seen) < count:
            await asyncio.sleep(0.001)

    async def run() -> None:
        outer = AsyncSafeSignalManager(asyncio.get_running_loop())
        outer.handle(signal.SIGUSR1, lambda number: seen.append(('outer', number)))
        with outer:
            inner = AsyncSafeSignalManager(asyncio.get_running_loop())
            inner.handle(signal.SIGUSR1, lambda number: seen.append(('inner', number)))
            for manager, count in ((inner, 2), (contextlib.nullcontext(), 4)):
                with manager:
                    signal.raise_signal(signal.SIGUSR1)
                    await asyncio.wait_for(came(count), 10.0)
                seen.append(('left', 0))
        signal.raise_signal(signal.SIGUSR1)

    asyncio.run(run())
    number = signal.SIGUSR1
    signal.signal(number, before)
    assert seen == [
        *[('inner', number), ('outer', number), ('left', 0)],
        *[('outer', number), ('left', 0)],
        ('before', 0),
    ]


def test_a_service_runs_in_the_main_thread_only() -> None:
    with pytest.raises(RuntimeError, match='can only be run in the main thread'):
        asyncio.run(asyncio.to_thread(LaunchService().run))
