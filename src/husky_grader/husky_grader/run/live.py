# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Run somebody's own controller: the simulator and the node as processes in a domain of their own.

The result is the simulator's record, in simulated time.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass, field, replace
import os
from pathlib import Path
import shlex
import signal
import sys
import time
from typing import Any

from husky_course.record import FILE_NAME, read_record, Record
from husky_course.route import Route
from husky_runtime.children import ChildProcess, tail_of
from husky_runtime.descendants import descendants_ended
from husky_runtime.domains import DomainError, OwnDomain
from husky_runtime.executor import make_executor
from husky_runtime.shared_memory import clean_shared_memory
import rclpy
from rclpy.executors import Executor
from rclpy.signals import SignalHandlerOptions

from husky_grader.run.referee import Referee, START_WITHIN_SEC
from husky_grader.run.watcher import Watcher
from husky_grader.scoring.report import Report

SIMULATOR_WITHIN_SEC = 30.0  # wall time, for its first message
CLOSED_WITHIN_SEC = 5.0  # wall time, for a simulator and its record
SILENCE_SEC = 10.0  # wall time: a simulator that says nothing for so long has died
DISCOVERY_SEC = 6.0  # wall time: so long nodes may need to find each other
HOPELESS_SEC = 3.0  # wall time: so long a mistake on the graph must be seen
RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
CHECK_FIELDS = 'ROS_PYTHON_CHECK_FIELDS'  # an int in a float's place is an error, not 5e-324
LOOK_SEC = 0.5  # between two checks of the graph


class LiveRunFailed(ValueError):
    """The run could not take place; it says nothing about the controller."""


@dataclass
class LiveRun:
    """A finished run: the record, why it ended, and what was noticed on the way."""

    record: Record
    ending: str
    notes: list[str] = field(default_factory=list)

    def with_notes(self, report: Report) -> Report:
        """Return the report with the notes among its reasons; a run that passed needs none."""
        return report if report.passed else replace(report, reasons=(*self.notes, *report.reasons))


def drive_live(
    command: str,
    route: Route,
    folder: Path,
    *,
    world: str = '',
    answers: str = '',
    real_time_factor: float = 1.0,
    environment: Mapping[str, str] | None = None,
) -> LiveRun:
    """
    Run the simulator and the command until the run is over.

    :param answers: what is typed into the controller, for one that asks.
    :param environment: of the controller; the grader's own when left out.
    :raises LiveRunFailed: when the simulator or the command cannot be started.
    """
    folder.mkdir(parents=True, exist_ok=True)
    record = folder / FILE_NAME
    record.unlink(missing_ok=True)
    simulator = [
        sys.executable,
        '-m',
        'husky_sim.ros.node',
        '--ros-args',
        '-p',
        f'record:={record}',
    ]
    simulator += ['-p', f'real_time_factor:={float(real_time_factor)}']
    simulator += ['-p', f'world:={world}'] if world else []
    patience_sec = max(START_WITHIN_SEC, DISCOVERY_SEC * real_time_factor)
    with (
        _own_domain() as (graph, watcher, executor),
        descendants_ended(),
        (folder / 'simulator.log').open('w') as log,
        ChildProcess(simulator, {**os.environ, **graph}, log) as running,
    ):
        _await_simulator(watcher, executor, running, folder)
        theirs = {CHECK_FIELDS: '1', **(environment or os.environ), **graph}
        controller = _start(command, theirs, folder, answers)
        referee = Referee(route, start_within_sec=patience_sec)
        ending, notes = _watch(watcher, executor, running, controller, referee, folder)
    if not record.is_file():
        raise LiveRunFailed(f'the simulator left no record; see {folder / "simulator.log"}')
    return LiveRun(read_record(record), ending, notes)


@contextmanager
def _own_domain() -> Iterator[tuple[dict[str, str], Watcher, Executor]]:
    """Open a DDS domain of this run alone, with a watcher in it; the dict is its environment."""
    context = rclpy.Context()
    with ExitStack() as stack:
        stack.callback(clean_shared_memory)
        try:
            domain = stack.enter_context(OwnDomain()).number
        except DomainError as error:
            raise LiveRunFailed(str(error)) from None
        rclpy.init(
            context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
        )
        stack.callback(rclpy.shutdown, context=context)
        watcher = Watcher(context)
        stack.callback(watcher.destroy_node)
        executor = make_executor(context)
        executor.add_node(watcher)
        stack.callback(executor.remove_node, watcher)
        graph = {'ROS_DOMAIN_ID': str(domain), 'PYTHONUNBUFFERED': '1'}
        yield {**graph, RANGE: os.environ.get(RANGE, 'LOCALHOST')}, watcher, executor


def _await_simulator(
    watcher: Watcher, executor: Any, simulator: ChildProcess, folder: Path
) -> None:
    deadline = time.monotonic() + SIMULATOR_WITHIN_SEC
    while watcher.latest is None:
        executor.spin_once(timeout_sec=0.1)
        if simulator.exit_code is not None or time.monotonic() > deadline:
            tail = tail_of(folder / 'simulator.log', 1)
            raise LiveRunFailed(f'the simulator did not start: {tail or "it says nothing"}')


def _start(
    command: str, environment: Mapping[str, str], folder: Path, answers: str
) -> ChildProcess:
    try:
        with (folder / 'controller.log').open('w') as log:
            return ChildProcess(
                shlex.split(command), environment, log, answers, parent_death=signal.SIGKILL
            )
    except (OSError, IndexError, ValueError) as error:
        raise LiveRunFailed(f'{command!r} cannot be started: {error}') from None


def _watch(
    watcher: Watcher,
    executor: Any,
    simulator: ChildProcess,
    controller: ChildProcess,
    referee: Referee,
    folder: Path,
) -> tuple[str, list[str]]:
    ending, seen = '', watcher.count
    pose_sec = looked_sec = time.monotonic()
    with controller:
        while not ending:
            executor.spin_once(timeout_sec=0.1)
            now = time.monotonic()
            if now - looked_sec > LOOK_SEC:
                looked_sec = now
                watcher.check_graph()
            if watcher.refused:
                ending = watcher.refused
            elif watcher.count != seen:
                seen, pose_sec = watcher.count, now
                ending = referee.over(**watcher.state(), running=controller.exit_code is None)
                if not referee.started and watcher.hinting_sec(now) > HOPELESS_SEC:
                    ending = 'its commands cannot be heard'
            elif now - pose_sec > SILENCE_SEC:
                raise LiveRunFailed(f'the simulator died; see {folder / "simulator.log"}')
        exit_code = controller.exit_code
        # First: the record must not show how the controller was ended.
        simulator.end(within_sec=CLOSED_WITHIN_SEC)
    notes = list(watcher.hints)
    if exit_code:
        how = f'exit code {exit_code}' if exit_code > 0 else signal.Signals(-exit_code).name
        tail = tail_of(folder / 'controller.log', 1)
        notes.insert(0, f'it crashed ({how})' + (f': {tail}' if tail else ''))
    return ending, notes
