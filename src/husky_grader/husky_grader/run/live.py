# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Run somebody's own controller in a jail, and the simulator beside it, in the same network.

The result is the simulator's record, in simulated time.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
import os
from pathlib import Path
import shlex
import shutil
import signal
import time

from husky_course.record import FILE_NAME, read_record, Record
from husky_runtime.children import ChildProcess, tail_of
from husky_runtime.shared_memory import clean_shared_memory

from husky_grader.jail import Jail, JailedProcess
from husky_grader.run.diagnosis import crash, how_it_ended, reasons
from husky_grader.run.printed import read_printed, shown, without_machine
from husky_grader.run.rest import tell_first
from husky_grader.run.told import listen, Told
from husky_grader.run.trusted import trusted
from husky_grader.scoring.report import Report

SIMULATOR_WITHIN_SEC = 30.0  # wall time, for its first word
SILENCE_SEC = 20.0  # wall time: a simulator that tells no news for so long has died
CHECK_FIELDS = 'ROS_PYTHON_CHECK_FIELDS'  # an int in a float's place is an error, not 5e-324
WALL_SEC = 600.0  # for a whole run: one that answers each message late would take hours
POLL_SEC = 0.05

Progress = Callable[[Told], object]


class LiveRunFailed(ValueError):
    """The run could not take place; it says nothing about the controller."""


class SimulatorNotStarted(LiveRunFailed):
    """The simulator failed before the command was started."""


@dataclass
class LiveRun:
    """A finished run: the record, why it ended, and what was noticed on the way."""

    record: Record
    ending: str
    pace: str  # how time passed
    notes: tuple[str, ...] = ()
    printed: str = ''  # by the controller

    def with_notes(self, report: Report) -> Report:
        """Return the report with the notes among its reasons; a run that passed needs none."""
        notes = () if report.passed else self.notes
        return replace(
            report,
            reasons=(*notes, *report.reasons),
            ending=self.ending,
            pace=self.pace,
            printed=self.printed,
        )


def drive_live(
    command: str,
    waypoints: str,
    folder: Path,
    jail: Jail,
    *,
    world: str = '',
    interface: str = 'lab',
    answers: str = '',
    real_time_factor: float = 1.0,
    environment: Mapping[str, str] | None = None,
    start_in: Path | None = None,
    without: str = '',
    on_progress: Progress = lambda _: None,
) -> LiveRun:
    """
    Run the simulator and the command until the run is over.

    :param waypoints: the file of the course.
    :param interface: lab, or clearpath: what a real A200 has as well.
    :param answers: what is typed into the controller, for one that asks.
    :param real_time_factor: simulated seconds a second at most, for a controller that does not
        answer each odometry message; one that does is as fast as it can be.
    :param jail: where the controller runs; the simulator runs beside it.
    :param environment: of the controller, besides that of the jail.
    :param start_in: the folder in which the controller starts; that of the jail when left out.
    :param without: what is left out of what the controller has printed, see `read_printed`.
    :param on_progress: called about twice a second.
    :raises LiveRunFailed: when the simulator or the command cannot be started.
    """
    folder = folder.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    record, told, first = (folder / name for name in (FILE_NAME, 'trial.json', 'controller.pid'))
    for file in (record, told, first):
        file.unlink(missing_ok=True)
    trial = trusted('husky_grader.run.trial', '--waypoints', str(Path(waypoints).absolute()))
    trial += ['--record', str(record), '--told', str(told), '--controller', str(first)]
    trial += ['--real-time-factor', f'{real_time_factor:g}', '--interface', interface]
    trial += ['--world', str(Path(world).absolute()) if world else '']
    theirs = {CHECK_FIELDS: '1', 'PYTHONUNBUFFERED': '1', **(environment or {})}
    with (
        (folder / 'simulator.log').open('w') as log,
        ChildProcess(jail.beside(trial), {**os.environ, **jail.graph}, log) as simulator,
    ):
        _await_simulator(simulator, told, folder)
        words = _on_simulated_time(_words(command))
        if start_in is not None:
            words = ['env', '-C', str(start_in), *words]
        printed_in = folder / 'controller.log'
        with jail.started(words, theirs, log=printed_in, answers=answers) as controller:
            last = _watch(simulator, controller, told, first, on_progress)
            exit_code = controller.exit_code
    first.unlink(missing_ok=True)
    clean_shared_memory()
    if not record.is_file():
        raise LiveRunFailed(f'the simulator left no record{_why_in(folder)}')
    printed = read_printed(printed_in, without=without)
    whole = read_record(record)
    unsent = last.unsent
    if exit_code == 0 and not whole.has_commands:
        unsent = [how_it_ended(exit_code, printed)]
    simulator_log = read_printed(folder / 'simulator.log')
    notes = reasons(printed, simulator_log, last.notes, exit_code, unsent)
    notes = tuple(map(without_machine, notes))
    return LiveRun(whole, last.ending, last.pace, notes, shown(printed))


def _await_simulator(simulator: ChildProcess, told: Path, folder: Path) -> None:
    deadline = time.monotonic() + SIMULATOR_WITHIN_SEC
    while (news := listen(told)) is None or news.failure:
        if simulator.wait(POLL_SEC) or time.monotonic() > deadline:
            news = listen(told)
            why = news.failure if news else tail_of(folder / 'simulator.log', 1)
            raise SimulatorNotStarted(f'the simulator did not start: {why or "it says nothing"}')


def _words(command: str) -> list[str]:
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise LiveRunFailed(f'{command!r} cannot be started: {error}') from None
    if not words or shutil.which(words[0]) is None:
        raise LiveRunFailed(f'{command!r} cannot be started: there is no such program')
    return words


def _on_simulated_time(words: list[str]) -> list[str]:
    """Add what makes a node's own clock that of /clock; a launch says it to its nodes itself."""
    if words[:2] == ['ros2', 'launch']:
        return words
    return [*words, '--ros-args', '-p', 'use_sim_time:=true']


def _watch(
    simulator: ChildProcess,
    controller: JailedProcess,
    told: Path,
    first: Path,
    on_progress: Progress,
) -> Told:
    """
    Wait until the simulator says that the run is over; return what it told last.

    :param first: the file from which the simulator knows the controller's first process.
    """
    begun_sec = time.monotonic()
    heard, heard_sec, gone, late = None, begun_sec, False, False
    while not simulator.wait(POLL_SEC):
        if not first.exists() and (number := controller.first_pid) is not None:
            tell_first(first, number)
        if not late and time.monotonic() - begun_sec > WALL_SEC:
            late = True
            simulator.send(signal.SIGINT)
        if controller.exit_code is not None and not gone:
            gone = True
            simulator.send(signal.SIGUSR1)
        news = listen(told)
        if news is not None and news != heard:
            heard, heard_sec = news, time.monotonic()
            on_progress(news)
        elif time.monotonic() - heard_sec > SILENCE_SEC:
            break
    last = listen(told)
    if last is None or not last.ending:
        raise LiveRunFailed(f'the simulator died{_why_in(told.parent)}')
    return replace(last, ending=f'it took {WALL_SEC:g} s on the clock') if late else last


def _why_in(folder: Path) -> str:
    """Return what the simulator's log says of its end, such as a full disk, and where it is."""
    log = folder / 'simulator.log'
    said = crash(read_printed(log))
    return f'{": " if said else ""}{said}; see {folder.name}/{log.name}'
