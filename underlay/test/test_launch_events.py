# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Event handlers, timers, functions and loops."""

import asyncio
from collections.abc import Callable
from pathlib import Path
import re
import signal
import time
from typing import Any

from launch import Action, Event, EventHandler, LaunchContext, LaunchDescription, LaunchService
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    ForEach,
    ForLoop,
    GroupAction,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
)
from launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
)
from launch.events import matches_action
from launch.events.process import (
    matches_executable,
    matches_name,
    matches_pid,
    ShutdownProcess,
    SignalProcess,
)
from launch.substitutions import LaunchConfiguration, TextSubstitution
import psutil
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]

pytestmark = pytest.mark.usefixtures('launch_environment')


def _run(*actions: Any) -> int:
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription(actions))
    return service.run()


def _note(notes: list[str], text: str) -> OpaqueFunction:
    return OpaqueFunction(function=lambda _: notes.append(text))


def test_on_process_exit_follows_one_process_only() -> None:
    notes: list[str] = []
    first = ExecuteProcess(cmd=['true'])
    second = ExecuteProcess(cmd=['sh', '-c', 'exit 7'])
    codes: list[int] = []
    _run(
        first,
        RegisterEventHandler(
            OnProcessExit(target_action=first, on_exit=[_note(notes, 'first is over'), second])
        ),
        RegisterEventHandler(
            OnProcessExit(
                target_action=second, on_exit=lambda event, _: codes.append(event.returncode)
            )
        ),
        RegisterEventHandler(
            OnProcessExit(
                target_action=lambda action: action is second,
                on_exit=lambda *_: [None, _note(notes, 'last')],
            )
        ),
    )
    assert notes == ['first is over', 'last']
    assert codes == [7]
    assert second.return_code == 7


def test_handlers_refuse_what_is_no_action_of_theirs() -> None:
    refused: Any = 'first'
    with pytest.raises(TypeError, match=r"requires an ExecuteLocal action .* got 'first'"):
        OnProcessExit(target_action=refused, on_exit=[])
    with pytest.raises(TypeError, match='OnProcessExit: 5 is neither an action, a list of'):
        OnProcessExit(on_exit=5)
    with pytest.raises(TypeError, match=r"requires an Action action .* got 'first'"):
        OnExecutionComplete(target_action=refused, on_completion=[])


def test_on_process_io_sees_what_is_written() -> None:
    seen: list[tuple[str, bytes]] = []

    def note(kind: str) -> Callable[[Any], None]:
        return lambda event: seen.append((kind, event.text))

    process = ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'])
    handlers = [
        OnProcessIO(target_action=process, on_stdout=note('out'), on_stderr=note('err')),
        OnProcessIO(on_stderr=note('any')),
    ]
    assert _run(process, *(RegisterEventHandler(handler) for handler in handlers)) == 0
    assert sorted(seen) == [('any', b'err\n'), ('err', b'err\n'), ('out', b'out\n')]


def test_cached_output_can_be_read_afterwards() -> None:
    process = ExecuteProcess(cmd=['sh', '-c', 'echo out; printf err >&2'], cached_output=True)
    _run(process)
    assert (process.get_stdout(), process.get_stderr()) == ('out\n', 'err')
    with pytest.raises(RuntimeError, match='cached_output must be true to be able to get stdout'):
        ExecuteProcess(cmd=['true']).get_stdout()


@pytest.mark.parametrize('emulate_tty', [False, True])
def test_who_inherits_the_output_of_a_process_holds_nothing_up(emulate_tty: bool) -> None:
    open_files: list[int] = []
    for command in ('echo 0', 'sleep 30 & echo $!'):
        process = ExecuteProcess(
            cmd=['sh', '-c', command], cached_output=True, emulate_tty=emulate_tty
        )
        _run(process, ExecuteProcess(cmd=['/no/such/program'], emulate_tty=emulate_tty))
        open_files.append(psutil.Process().num_fds())
    grandchild = psutil.Process(int(process.get_stdout()))
    assert grandchild.status() != psutil.STATUS_ZOMBIE
    grandchild.kill()
    assert open_files[1] <= open_files[0]


def test_on_shutdown_comes_with_the_reason() -> None:
    reasons: list[str] = []
    _run(
        RegisterEventHandler(
            OnShutdown(on_shutdown=lambda event, _: reasons.append(event.reason))
        ),
        Shutdown(reason='enough'),
    )
    assert reasons == ['enough']


def test_on_execution_complete_follows_an_action() -> None:
    notes: list[str] = []
    timer = TimerAction(period=0.05, actions=[])
    _run(
        RegisterEventHandler(
            OnExecutionComplete(target_action=timer, on_completion=[_note(notes, 'complete')])
        ),
        timer,
    )
    assert notes == ['complete']


@pytest.mark.parametrize(
    'period',
    ['0.05', 0.05, LaunchConfiguration('p', default='0.05'), [TextSubstitution(text='0.05')]],
)
def test_a_timer_rings_after_its_period(period: Any) -> None:
    rung_sec: list[float] = []
    ring = OpaqueFunction(function=lambda _: rung_sec.append(time.monotonic()))
    begin_sec = time.monotonic()
    assert _run(TimerAction(period=period, actions=[ring])) == 0
    assert [each - begin_sec >= 0.05 for each in rung_sec] == [True]


def test_a_timer_can_be_cancelled() -> None:
    notes: list[str] = []
    timer = TimerAction(period=30.0, actions=[_note(notes, 'never')])
    _run(
        timer,
        TimerAction(period=0.05, actions=[OpaqueFunction(function=lambda _: timer.cancel())]),
    )
    assert notes == []
    assert timer.is_canceled


def test_a_timer_that_was_cancelled_or_has_rung_can_be_made_ready_again() -> None:
    notes: list[str] = []
    timer = TimerAction(period=0.01, actions=[_note(notes, 'rang')])
    timer.cancel()
    assert (_run(timer), notes) == (0, [])
    for _ in range(2):
        timer.reset()
        assert _run(timer) == 0
    assert notes == ['rang'] * 2


def test_a_timer_that_is_made_ready_while_it_runs_begins_anew() -> None:
    times_sec: list[float] = []
    note = OpaqueFunction(function=lambda _: times_sec.append(time.monotonic()))
    timer = TimerAction(period=0.1, actions=[note])

    def begin_anew(_: LaunchContext) -> list[Action]:
        timer.reset()
        return [note, timer]

    late = OpaqueFunction(function=lambda _: time.sleep(0.15))  # so that both ring at once
    _run(timer, TimerAction(period=0.05, actions=[OpaqueFunction(function=begin_anew)]), late)
    begun_sec, rung_sec = times_sec
    assert rung_sec - begun_sec >= 0.1


def test_actions_of_a_timer_know_what_was_known_where_it_stands(
    launch_file: LaunchFile, python_launch_file: LaunchFile, run_launch: Run
) -> None:
    logs_place = '[LogInfo(msg=[ThisLaunchFile()])]'
    launch_file('<launch><log message="leaf"/></launch>', 'leaf.launch.xml')
    launch_file(
        '<launch><log message="timers"/><timer period="0.05"><log message="in $(filename)"/>'
        '<include file="$(dirname)/leaf.launch.xml"/></timer></launch>',
        'timers.launch.xml',
    )
    outer = python_launch_file(
        f"""
        IncludeLaunchDescription([ThisLaunchFileDir(), '/timers.launch.xml']),
        ENDS,
        RegisterEventHandler(OnProcessExit(target_action=ENDS, on_exit=[
            TimerAction(period=0.05, actions=[
                LogInfo(msg=['ended with ', LocalSubstitution('event.returncode')])])])),
        RegisterEventHandler(OnShutdown(on_shutdown={logs_place})),
        """,
        before="ENDS = ExecuteProcess(cmd=['sh', '-c', 'exit 7'])",
    )
    launched = run_launch(outer)
    logged = [line.partition(']: ')[2] for line in launched.lines if 'launch.user' in line]
    assert logged == [
        'timers',
        f'in {outer.with_name("timers.launch.xml")}',
        'leaf',
        'ended with 7',
        f'{outer}',
    ]


@pytest.mark.parametrize(
    ('given', 'expected'),
    [
        ({'cancel_on_shutdown': LaunchConfiguration('no')}, ['rang']),
        ({'cancel_on_shutdown': LaunchConfiguration('yes')}, []),
        ({}, []),
    ],
)
def test_a_timer_asks_whether_the_end_cancels_it_where_it_stands(
    given: dict[str, Any], expected: list[str]
) -> None:
    notes: list[str] = []
    timer = TimerAction(period=0.05, actions=[_note(notes, 'rang')], **given)
    group = GroupAction([timer], launch_configurations={'no': 'false', 'yes': 'true'})
    assert _run(group, Shutdown()) == 0
    assert notes == expected


def test_a_timer_in_xml_goes_on_at_the_end_where_it_says_so(
    launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        launch_file(
            """
            <launch>
              <timer period="0.05"><log message="cancelled"/></timer>
              <timer period="0.05" cancel_on_shutdown="false"><log message="rang"/></timer>
              <shutdown/>
            </launch>
            """,
            'test.launch.xml',
        )
    )
    assert '[INFO] [launch.user]: rang' in launched.lines
    assert 'cancelled' not in launched.output


def test_own_events_reach_own_handlers_until_unregistered() -> None:
    class Ring(Event):
        name = 'Ring'

    notes: list[str] = []
    handler = EventHandler(
        matcher=lambda event: isinstance(event, Ring), entities=_note(notes, 'ring')
    )
    _run(
        RegisterEventHandler(handler),
        EmitEvent(event=Ring()),
        EmitEvent(event=Ring()),
        TimerAction(
            period=0.05, actions=[UnregisterEventHandler(handler), EmitEvent(event=Ring())]
        ),
    )
    assert notes == ['ring', 'ring']


def test_what_a_handler_makes_known_ends_with_it() -> None:
    known: list[bool] = []

    def know(_event: Event, context: LaunchContext) -> None:
        known.append('secret' in context.get_locals_as_dict())
        context.extend_locals({'secret': 'x'})

    handlers = [RegisterEventHandler(OnShutdown(on_shutdown=know)) for _ in range(2)]
    assert _run(*handlers, Shutdown(), Shutdown()) == 0
    assert known == [False] * 4


def test_a_handler_that_handles_once_does() -> None:
    notes: list[str] = []
    _run(
        RegisterEventHandler(
            OnProcessExit(on_exit=[_note(notes, 'the first of both')], handle_once=True)
        ),
        ExecuteProcess(cmd=['true']),
        ExecuteProcess(cmd=['true']),
    )
    assert notes == ['the first of both']


def test_shutdown_process_ends_the_matching_process_only(
    capsys: pytest.CaptureFixture[str],
) -> None:
    ended: list[str] = []
    sleepers = [ExecuteProcess(cmd=['sleep', '30'], name=name) for name in ('one', 'two')]

    def end_one(_context: LaunchContext) -> EmitEvent:
        details = sleepers[0].process_details
        assert details is not None
        return EmitEvent(event=ShutdownProcess(process_matcher=matches_name(details['name'])))

    def on_exit(event: Any, _context: LaunchContext) -> Shutdown:
        ended.append(event.process_name.partition('-')[0])
        return Shutdown()

    end = OpaqueFunction(function=end_one)
    _run(
        *sleepers,
        RegisterEventHandler(OnProcessExit(on_exit=on_exit)),
        TimerAction(period=0.2, actions=[end, end]),  # once is enough, twice no error
    )
    assert ended == ['one', 'two']
    assert [sleeper.return_code for sleeper in sleepers] == [-signal.SIGINT] * 2
    told = re.findall(
        r'^\[\w+\] \[(\w+)-\d+\]: (sending|process has died)', capsys.readouterr().out, re.M
    )
    dies = 'process has died'
    assert told == [(name, what) for name in ('one', 'two') for what in ('sending', dies)]


def test_matchers_know_a_process_by_name_pid_and_executable() -> None:
    process = ExecuteProcess(cmd=['/bin/true'], name='one')
    matchers = [matches_name('one-1'), matches_pid(1), matches_executable('true')]
    assert not any(matches(process) for matches in matchers)  # it has not been executed
    _run(process)
    details = process.process_details
    assert details is not None
    cases: list[tuple[Any, list[Any], list[Any]]] = [
        (matches_name, [details['name']], ['one']),
        (matches_pid, [details['pid']], [1]),
        (matches_executable, ['true', 'in/true', '/bin/true'], ['tru', '/true/']),
    ]
    for matches, known, unknown in cases:
        assert all(matches(each)(process) for each in known)
        assert not any(matches(each)(process) for each in unknown)


def test_a_process_that_is_just_starting_is_ended_as_soon_as_it_runs() -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'])
    assert _run(sleeper, Shutdown()) == 0
    assert sleeper.return_code == -signal.SIGINT


def test_nor_does_one_go_on_that_is_just_starting_again() -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'], respawn=True)
    matcher = matches_action(sleeper)
    codes: list[int] = []

    def on_exit(event: Any, _context: LaunchContext) -> EmitEvent:
        codes.append(event.returncode)
        return EmitEvent(event=ShutdownProcess(process_matcher=matcher))

    terminate = EmitEvent(event=SignalProcess(signal_number='SIGTERM', process_matcher=matcher))
    on_start = OnProcessStart(target_action=sleeper, on_start=[terminate], handle_once=True)
    on_end = OnProcessExit(target_action=sleeper, on_exit=on_exit)
    assert _run(RegisterEventHandler(on_start), RegisterEventHandler(on_end), sleeper) == 0
    assert codes == [-signal.SIGTERM, -signal.SIGINT]


def test_a_signal_for_a_process_that_has_not_started_is_an_error(
    capsys: pytest.CaptureFixture[str],
) -> None:
    sleeper = ExecuteProcess(cmd=['sleep', '30'], name='sleeper')
    early = SignalProcess(signal_number='SIGUSR1', process_matcher=matches_action(sleeper))
    assert _run(sleeper, EmitEvent(event=early)) == 1
    text = r"signal 'SIGUSR1' for process\[sleeper-\d+\] came before it was started"
    assert re.search(text, capsys.readouterr().out)


def test_a_respawn_waits_for_its_delay() -> None:
    begun_sec: list[float] = []
    process = ExecuteProcess(cmd=['true'], respawn=True, respawn_delay=0.3, respawn_max_retries=1)
    note = OpaqueFunction(function=lambda _: begun_sec.append(time.monotonic()))
    _run(RegisterEventHandler(OnProcessStart(target_action=process, on_start=[note])), process)
    first_sec, second_sec = begun_sec
    assert second_sec - first_sec >= 0.3


def test_functions_return_actions_and_coroutines_run_beside() -> None:
    notes: list[str] = []

    async def tick(_context: LaunchContext, text: str) -> None:
        await asyncio.sleep(0.01)
        notes.append(text)

    _run(
        OpaqueFunction(function=lambda _, text: [_note(notes, text)], args=['from function']),
        OpaqueCoroutine(coroutine=tick, args=['from coroutine']),
    )
    assert notes == ['from function', 'from coroutine']


def test_the_end_of_the_launch_cancels_a_coroutine() -> None:
    begun: list[str] = []

    async def wait(_context: LaunchContext, *, text: str) -> None:
        begun.append(text)
        await asyncio.sleep(60.0)

    begin_sec = time.monotonic()
    waiting = OpaqueCoroutine(coroutine=wait, kwargs={'text': 'begun'})
    assert _run(waiting, TimerAction(period=0.05, actions=[Shutdown()])) == 0
    assert (begun, time.monotonic() - begin_sec < 30.0) == (['begun'], True)


def test_loops_repeat_their_actions(python_launch_file: LaunchFile, launch_here: Run) -> None:
    launched = launch_here(
        python_launch_file(
            """
            ForLoop('3', function=lambda i: [LogInfo(msg=f'turn {i}')]),
            ForEach('{name: a, x: 1};{name: b, x: 2}',
                    function=lambda name, x: [LogInfo(msg=f'{name} at {x}')]),
            ForLoop(0, function=lambda i: [LogInfo(msg='never')]),
            ForEach(' ; ', function=lambda: [LogInfo(msg='never')]),
            ForLoop(1, function=lambda index: [LogInfo(msg='refused by upstream')]),
            """
        )
    )
    expected = ['turn 0', 'turn 1', 'turn 2', 'a at 1', 'b at 2']
    assert [
        line.partition(']: ')[2] for line in launched.lines if 'launch.user' in line
    ] == expected
    assert [line for line in launched.lines if 'WARNING' in line] == [
        '[WARNING] [launch]: a loop starts nothing: its length is 0',
        '[WARNING] [launch]: a loop starts nothing: it has no values',
    ]
    assert "got an unexpected keyword argument 'i'" in launched.output
    assert launched.returncode == 1


def _log(text: str) -> list[LogInfo]:
    return [LogInfo(msg=text)]


@pytest.mark.parametrize(
    ('loop', 'message'),
    [
        (ForLoop('many', function=_log), "the length of a loop is 'many', not a whole"),
        (ForEach('{text: a}; b', function=_log), "'b' is not a mapping as {name: value}"),
        (ForEach('{b: 1}', function=_log), "missing a required argument: 'text', given"),
    ],
)
def test_a_loop_that_cannot_be_is_refused(loop: Action, message: str) -> None:
    with pytest.raises((ValueError, SyntaxError), match=message):
        loop.execute(LaunchContext())


def test_stdin_events_reach_the_process(python_launch_file: LaunchFile, run_launch: Run) -> None:
    launched = run_launch(
        python_launch_file(
            """
            CAT, OTHER,
            RegisterEventHandler(OnProcessStart(target_action=OTHER, on_start=lambda event, _: [
                EmitEvent(event=ProcessStdin(text=b'typed\\n', **CAT.process_details))])),
            RegisterEventHandler(OnProcessExit(target_action=CAT, on_exit=[Shutdown()])),
            """,
            before="""
            CAT = ExecuteProcess(cmd=['head', '-n1'], output='screen')
            OTHER = ExecuteProcess(cmd=['head', '-n1'], output='screen')
            """,
        )
    )
    assert '[head-1] typed' in launched.lines
    assert '[head-2] typed' not in launched.lines
