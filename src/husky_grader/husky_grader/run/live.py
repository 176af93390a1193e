# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Run somebody's own controller: it and the simulator are processes in a domain of their own.

The result is the simulator's record, in simulated time.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
import os
from pathlib import Path
import shlex
import signal
import sys
import time

from husky_course.record import FILE_NAME, read_record, Record
from husky_runtime.children import ChildProcess, tail_of
from husky_runtime.descendants import descendants_ended
from husky_runtime.domains import DomainError, OwnDomain
from husky_runtime.shared_memory import clean_shared_memory

from husky_grader.run.diagnosis import reasons
from husky_grader.run.printed import read_printed, shown
from husky_grader.run.told import listen, Told
from husky_grader.scoring.report import Report

SIMULATOR_WITHIN_SEC = 30.0  # wall time, for its first word
CLOSED_WITHIN_SEC = 5.0  # wall time, for a simulator and its record
SILENCE_SEC = 20.0  # wall time: a simulator that tells no news for so long has died
RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
CHECK_FIELDS = 'ROS_PYTHON_CHECK_FIELDS'  # an int in a float's place is an error, not 5e-324
POLL_SEC = 0.05

Progress = Callable[[Told], object]


class LiveRunFailed(ValueError):
    """The run could not take place; it says nothing about the controller."""


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
    *,
    world: str = '',
    answers: str = '',
    real_time_factor: float = 1.0,
    environment: Mapping[str, str] | None = None,
    on_progress: Progress = lambda _: None,
) -> LiveRun:
    """
    Run the simulator and the command until the run is over.

    :param waypoints: the file of the course.
    :param answers: what is typed into the controller, for one that asks.
    :param real_time_factor: simulated seconds a second, for a controller that has a clock of its
        own; one that answers each odometry message is waited for instead.
    :param environment: of the controller; the grader's own when left out.
    :param on_progress: called about twice a second.
    :raises LiveRunFailed: when the simulator or the command cannot be started.
    """
    folder.mkdir(parents=True, exist_ok=True)
    record, told = folder / FILE_NAME, folder / 'trial.json'
    for file in (record, told):
        file.unlink(missing_ok=True)
    trial = [sys.executable, '-m', 'husky_grader.run.trial']
    trial += ['--waypoints', waypoints, '--record', str(record), '--told', str(told)]
    trial += ['--real-time-factor', f'{real_time_factor:g}', '--world', world]
    with (
        _own_domain() as graph,
        descendants_ended(),
        (folder / 'simulator.log').open('w') as log,
        ChildProcess(trial, {**os.environ, **graph}, log) as simulator,
    ):
        _await_simulator(simulator, told, folder)
        theirs = {CHECK_FIELDS: '1', **(environment or os.environ), **graph}
        with _started(command, theirs, folder, answers) as controller:
            last = _watch(simulator, controller, told, folder, on_progress)
            exit_code = controller.exit_code
    if not record.is_file():
        raise LiveRunFailed(f'the simulator left no record; see {folder / "simulator.log"}')
    printed = read_printed(folder / 'controller.log')
    notes = reasons(printed, read_printed(folder / 'simulator.log'), last.notes, exit_code)
    return LiveRun(read_record(record), last.ending, last.pace, notes, shown(printed))


@contextmanager
def _own_domain() -> Iterator[dict[str, str]]:
    """Take a DDS domain of this run alone; give its environment."""
    try:
        domain = OwnDomain()
    except DomainError as error:
        raise LiveRunFailed(str(error)) from None
    with domain:
        graph = {'ROS_DOMAIN_ID': str(domain.number), 'PYTHONUNBUFFERED': '1'}
        try:
            yield {**graph, RANGE: os.environ.get(RANGE, 'LOCALHOST')}
        finally:
            clean_shared_memory()


def _await_simulator(simulator: ChildProcess, told: Path, folder: Path) -> None:
    deadline = time.monotonic() + SIMULATOR_WITHIN_SEC
    while (news := listen(told)) is None or news.failure:
        if simulator.wait(POLL_SEC) or time.monotonic() > deadline:
            news = listen(told)
            why = news.failure if news else tail_of(folder / 'simulator.log', 1)
            raise LiveRunFailed(f'the simulator did not start: {why or "it says nothing"}')


def _started(
    command: str, environment: Mapping[str, str], folder: Path, answers: str
) -> ChildProcess:
    try:
        with (folder / 'controller.log').open('w') as log:
            words = _on_simulated_time(shlex.split(command))
            return ChildProcess(words, environment, log, answers, parent_death=signal.SIGKILL)
    except (OSError, IndexError, ValueError) as error:
        raise LiveRunFailed(f'{command!r} cannot be started: {error}') from None


def _on_simulated_time(words: list[str]) -> list[str]:
    """Add what makes a node's own clock that of /clock; a launch says it to its nodes itself."""
    if words[:2] == ['ros2', 'launch']:
        return words
    return [*words, '--ros-args', '-p', 'use_sim_time:=true']


def _watch(
    simulator: ChildProcess,
    controller: ChildProcess,
    told: Path,
    folder: Path,
    on_progress: Progress,
) -> Told:
    """Wait until the simulator says that the run is over; return what it told last."""
    heard, heard_sec, gone = None, time.monotonic(), False
    while not simulator.wait(POLL_SEC):
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
        raise LiveRunFailed(f'the simulator died; see {folder / "simulator.log"}')
    return last
