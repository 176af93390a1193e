# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Processes: output, ends, signals, respawn."""

from collections.abc import Callable
import os
from pathlib import Path
import re
import signal
import time
from typing import Any

from launch import LaunchContext
from launch.actions import ExecuteProcess
from launch.utilities import perform_substitutions
import pytest

LaunchFile = Callable[..., Path]
Run = Callable[..., Any]


def _is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return 'Z' not in Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[:1]


def _pids(output: str) -> list[int]:
    return [int(pid) for pid in re.findall(r'process started with pid \[(\d+)\]', output)]


def test_a_command_is_told_with_its_folder(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file(
            "ExecuteProcess(cmd=['echo', 'a'], log_cmd=True, name='one'),"
            "ExecuteProcess(cmd=['echo', 'b'], log_cmd=True, name='two', cwd='/'),"
        )
    )
    told = sorted(line for line in launched.lines if 'process details' in line)
    assert [line.partition('process details: ')[2] for line in told] == [
        "cmd='echo a', cwd='None', custom_env?=True",  # as upstream, which says so of each
        "cmd='echo b', cwd='/', custom_env?=True",
    ]


def test_a_process_is_reported_with_its_name_pid_and_end(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file("ExecuteProcess(cmd=['echo', 'hello'], output='screen'),")
    )
    text = '\n'.join(launched.lines)
    assert launched.returncode == 0
    assert re.match(r'\[INFO\] \[launch\]: All log files can be found below .+', launched.lines[0])
    assert launched.lines[1] == '[INFO] [launch]: Default logging verbosity is set to INFO'
    (pid,) = re.findall(r'^\[INFO\] \[echo-1\]: process started with pid \[(\d+)\]$', text, re.M)
    assert '[echo-1] hello' in launched.lines
    assert f'[INFO] [echo-1]: process has finished cleanly [pid {pid}]' in launched.lines


def test_launch_succeeds_and_reports_a_process_that_dies(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(python_launch_file("ExecuteProcess(cmd=['sh', '-c', 'exit 3']),"))
    (pid,) = _pids(launched.output)
    expected = f"[ERROR] [sh-1]: process has died [pid {pid}, exit code 3, cmd 'sh -c exit 3']."
    assert expected in launched.lines
    assert launched.returncode == 0


def test_a_program_that_does_not_exist_is_one_line(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(python_launch_file("ExecuteProcess(cmd=['no_such_program', 'x']),"))
    (line,) = [line for line in launched.lines if 'no_such_program-1' in line]
    assert line.startswith('[ERROR] [no_such_program-1]: cannot start the process:')
    assert 'Traceback' not in launched.output


def test_a_command_that_is_a_text_is_refused() -> None:
    with pytest.raises(TypeError, match=r"it is a list of words, as \['echo', 'hi'\]"):
        ExecuteProcess(cmd='echo hi')


def test_output_log_shows_only_stderr_and_the_log_file_has_both(
    python_launch_file: LaunchFile, launch_here: Run, tmp_path: Path
) -> None:
    launched = launch_here(
        python_launch_file("ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2']),")
    )
    assert '[sh-1] err' in launched.lines
    assert '[sh-1] out' not in launched.lines
    log = (tmp_path / 'ros_log' / 'latest' / 'launch.log').read_text()
    assert re.search(r'^\d+\.\d+ \[sh-1\] out$', log, re.M)
    assert re.search(r'^\d+\.\d+ \[INFO\] \[sh-1\]: process started', log, re.M)


@pytest.mark.parametrize(
    ('output', 'files'),
    [
        ('own_log', {'sh-1.log', 'sh-1-stdout.log', 'sh-1-stderr.log'}),
        ('full', {'sh-1.log', 'sh-1-stdout.log', 'sh-1-stderr.log'}),
        ('screen', set()),
    ],
)
def test_own_log_writes_files_of_the_process(
    output: str, files: set[str], python_launch_file: LaunchFile, launch_here: Run, tmp_path: Path
) -> None:
    launch_here(
        python_launch_file(
            f"ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'], output={output!r}),"
        )
    )
    folder = tmp_path / 'ros_log' / 'latest'
    assert {path.name for path in folder.iterdir()} - {'launch.log'} == files
    if files:
        assert (folder / 'sh-1-stdout.log').read_text() == '[sh-1] out\n'


def test_output_comes_as_soon_as_a_process_writes_it(
    python_launch_file: LaunchFile, interrupt_launch: Run
) -> None:
    path = python_launch_file(
        """
        ExecuteProcess(
            cmd=['python3', '-uc', 'import time; print("early"); time.sleep(30)'], output='screen'
        ),
        """
    )
    started = time.monotonic()
    launched = interrupt_launch(path, '[python3-1] early', signal.SIGINT)
    assert time.monotonic() - started < 5.0
    assert '[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)' in launched.lines


def test_emulate_tty_makes_the_child_believe_in_a_terminal(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file(
            """
            ExecuteProcess(cmd=['sh', '-c', 'test -t 1 && echo yes'], output='screen',
                           emulate_tty=True),
            ExecuteProcess(cmd=['sh', '-c', 'test -t 1 || echo no', 'sh'], output='screen',
                           emulate_tty=LaunchConfiguration('said', default='false'),
                           shell=LaunchConfiguration('said', default='false')),
            SetLaunchConfiguration('emulate_tty', '1'),  # wins over the arguments
            ExecuteProcess(cmd=['sh', '-c', 'test -t 1 && echo yes'], output='screen'),
            SetLaunchConfiguration('emulate_tty', 'false'),
            ExecuteProcess(cmd=['sh', '-c', 'test -t 1 || echo no'], output='screen',
                           emulate_tty=True),
            """
        )
    )
    said = [f'[sh-{number}] {word}' for number, word in enumerate(('yes', 'no') * 2, start=1)]
    assert set(said) <= set(launched.lines)


STUBBORN = """
ExecuteProcess(
    cmd=['sh', '-c', 'trap "" INT TERM HUP; echo up; while :; do sleep 0.1; done'],
    output='screen', sigterm_timeout='0.3', sigkill_timeout='0.3',
),
"""


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_stubborn_child_gets_sigint_sigterm_and_sigkill(
    number: signal.Signals, python_launch_file: LaunchFile, interrupt_launch: Run
) -> None:
    launched = interrupt_launch(python_launch_file(STUBBORN), '[sh-1] up', number)
    steps = [
        "sending signal 'SIGINT' to process[sh-1]",
        "process[sh-1] failed to terminate '0.3' seconds after receiving 'SIGINT', escalating to "
        "'SIGTERM'",
        "sending signal 'SIGTERM' to process[sh-1]",
        "process[sh-1] failed to terminate '0.6' seconds after receiving 'SIGTERM', escalating to "
        "'SIGKILL'",
        "sending signal 'SIGKILL' to process[sh-1]",
    ]
    places = [launched.output.find(step) for step in steps]
    assert -1 not in places, launched.output
    assert places[1:] == sorted(places[1:])
    assert 'exit code -9' in launched.output
    assert launched.returncode == 0
    assert not any(_is_running(pid) for pid in _pids(launched.output))


def test_a_child_has_its_time_after_sigterm_where_the_launch_stood_still(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        f"""
        {STUBBORN.strip()}
        RegisterEventHandler(OnProcessIO(on_stdout=lambda _: Shutdown())),
        RegisterEventHandler(EventHandler(
            matcher=lambda event: getattr(event, 'signal', None) == signal.SIGINT,
            entities=OpaqueFunction(function=lambda _: time.sleep(0.8)))),
        """,
        before='import signal, time\nfrom launch import EventHandler',
    )
    output = launch_here(path).output
    told = re.findall(r"(sending|escalating to) (?:signal )?'(SIG\w+)'", output)
    assert told == [
        ('sending', 'SIGINT'),
        *(('escalating to', 'SIGTERM'), ('sending', 'SIGTERM')),
        *(('escalating to', 'SIGKILL'), ('sending', 'SIGKILL')),
    ], output


def test_a_closed_terminal_ends_a_stubborn_child(
    python_launch_file: LaunchFile, launch_in_closed_terminal: Callable[[Path, str], str]
) -> None:
    output = launch_in_closed_terminal(python_launch_file(STUBBORN), '[sh-1] up')
    (child,) = _pids(output)
    assert not _is_running(child)


def test_ctrl_c_ends_every_child(python_launch_file: LaunchFile, interrupt_launch: Run) -> None:
    path = python_launch_file(
        """
        *[ExecuteProcess(cmd=['sleep', '60']) for _ in range(5)],
        ExecuteProcess(cmd=['sh', '-c', 'sleep 0.3; echo ready; exec sleep 60'], output='screen'),
        """
    )
    launched = interrupt_launch(path, 'ready', signal.SIGINT)
    assert len(_pids(launched.output)) == 6
    assert not any(_is_running(pid) for pid in _pids(launched.output))
    assert launched.returncode == 0


def test_ctrl_c_at_a_terminal_interrupts_a_child_once(
    python_launch_file: LaunchFile, terminal_launch: Callable[[Path, str, bytes], str]
) -> None:
    path = python_launch_file(
        """
        ExecuteProcess(cmd=['python3', '-c', CHILD], output='screen'),
        """,
        before='''
CHILD = """
import signal, time
count = 0
def interrupted(number, frame):
    global count
    count += 1
signal.signal(signal.SIGINT, interrupted)
print('ready', flush=True)
while not count:
    time.sleep(0.05)
time.sleep(0.8)
print('interrupted', count, 'times')
"""
''',
    )
    output = terminal_launch(path, 'ready', b'\x03')
    assert 'user interrupted with ctrl-c (SIGINT)' in output
    assert '[python3-1] interrupted 1 times' in output
    assert 'sending signal' not in output
    assert 'process has finished cleanly' in output


def test_each_signal_has_five_seconds_by_default() -> None:
    process = ExecuteProcess(cmd=['true'])
    timeouts = process.sigterm_timeout, process.sigkill_timeout
    assert [perform_substitutions(LaunchContext(), each) for each in timeouts] == ['5', '5']


SLOW_TO_END = """
ExecuteProcess(
    cmd=['sh', '-c', 'trap i=1 INT; echo up; until [ $i ]; do sleep 0.05; done; exec sleep 30'],
    name='slow', sigterm_timeout='0.6',
),
RegisterEventHandler(OnProcessIO(on_stdout=lambda event: EmitEvent(event=Shutdown({})))),
"""


@pytest.mark.parametrize(
    ('arguments', 'signals'),
    [("reason='done'", ['SIGINT', 'SIGTERM']), ('due_to_sigint=True', ['SIGTERM'])],
)
def test_an_end_without_ctrl_c_interrupts_a_child_once(
    arguments: str, signals: list[str], python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file(
        SLOW_TO_END.format(arguments), before='from launch.events import Shutdown'
    )
    launched = launch_here(path)
    sent = re.findall(r"sending signal '(\w+)' to process\[slow-1\]", launched.output)
    assert sent == signals, launched.output


def test_on_exit_shutdown_makes_a_process_required(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file(
            """
            ExecuteProcess(cmd=['sleep', '60']),
            ExecuteProcess(cmd=['sleep', '0.2'], on_exit=Shutdown(reason='done')),
            """
        )
    )
    required = '[INFO] [launch]: process[sleep-2] was required: shutting down launched system'
    assert required in launched.lines
    assert "sending signal 'SIGINT' to process[sleep-1]" in launched.output


def test_respawn_starts_again_as_often_as_it_may(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file(
            """
            ExecuteProcess(cmd=['sh', '-c', 'echo once; exit 1'], output='screen', respawn=True,
                           respawn_delay=0.05, respawn_max_retries=2),
            ExecuteProcess(cmd=['echo', 'thrice'], output='screen',
                           respawn=LaunchConfiguration('again', default='true'),
                           respawn_max_retries=LaunchConfiguration('often', default='2')),
            ExecuteProcess(cmd=['echo', 'once'], output='screen',
                           respawn=LaunchConfiguration('again', default='false')),
            """
        )
    )
    assert launched.lines.count('[sh-1] once') == 3
    assert launched.lines.count('[echo-2] thrice') == 3
    assert launched.lines.count('[echo-3] once') == 1


def test_shutdown_during_a_respawn_delay_ends_at_once(
    python_launch_file: LaunchFile, interrupt_launch: Run
) -> None:
    path = python_launch_file(
        "ExecuteProcess(cmd=['false'], respawn=True, respawn_delay=60.0), "
        "ExecuteProcess(cmd=['true']),"
    )
    started = time.monotonic()
    launched = interrupt_launch(path, 'process has died', signal.SIGINT)
    assert time.monotonic() - started < 5.0
    assert len(_pids(launched.output)) == 2


def test_environment_working_folder_prefix_and_shell(
    python_launch_file: LaunchFile, launch_here: Run, tmp_path: Path
) -> None:
    launched = launch_here(
        python_launch_file(
            f"""
            SetEnvironmentVariable('COLOUR', 'red'),
            ExecuteProcess(cmd=['echo', '$COLOUR', '$SHAPE', '$PWD'], shell=True, output='screen',
                           cwd={str(tmp_path)!r}, additional_env={{'SHAPE': 'round'}}),
            ExecuteProcess(cmd=['hello'], prefix='echo -n before', output='screen'),
            ExecuteProcess(cmd=['env'], env={{'ONLY': 'this'}}, output='screen', name='bare'),
            """
        )
    )
    assert f'[echo-1] red round {tmp_path}' in launched.lines
    assert '[echo-2] before hello' in launched.lines  # as upstream: the program that is started
    assert '[bare-3] ONLY=this' in launched.lines
    assert '[bare-3] COLOUR=red' not in launched.lines


def test_launch_prefix_is_filtered_by_name(
    python_launch_file: LaunchFile, launch_here: Run
) -> None:
    launched = launch_here(
        python_launch_file(
            """
            ExecuteProcess(cmd=['echo', 'one'], output='screen'),
            ExecuteProcess(cmd=['printf', 'two'], output='screen'),
            """
        ),
        'launch-prefix:=echo prefixed',
        'launch-prefix-filter:=ec.*',
    )
    assert '[echo-1] prefixed echo one' in launched.lines
    assert '[printf-2] two' in launched.lines


@pytest.mark.parametrize('value', ['soon', '-1', 'nan', 'inf'])
def test_a_timeout_that_is_no_number_starts_nothing(
    value: str, python_launch_file: LaunchFile, launch_here: Run
) -> None:
    path = python_launch_file("ExecuteProcess(cmd=['sleep', '30']),")
    launched = launch_here(path, f'sigterm_timeout:={value}')
    assert launched.returncode == 1
    assert f"sigterm_timeout is '{value}': it is a time in seconds" in launched.output
    assert 'process started' not in launched.output
