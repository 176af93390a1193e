# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Let somebody's own node drive: the simulator and the node as processes on a graph of their own.

What is judged is the simulator's record, in simulated time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import contextlib
from dataclasses import dataclass, field
import os
from pathlib import Path
import random
import shlex
import signal
import socket
import subprocess
import sys
import time
from types import TracebackType
from typing import Any, IO

import rclpy
from rclpy.signals import SignalHandlerOptions

from husky_driver.executor import make_executor
from husky_driver.referee import Referee, START_WITHIN_SEC
from husky_driver.run_record import load_record
from husky_driver.watcher import Watcher
from husky_driver.waypoints import Course

SIMULATOR_WITHIN_SEC = 30.0  # wall time, for its first message
SILENCE_SEC = 10.0  # wall time: a simulator that says nothing for so long has died
END_WITHIN_SEC = 5.0
DISCOVERY_SEC = 6.0  # wall time: so long nodes may need to find each other
HOPELESS_SEC = 3.0  # wall time: so long a mistake on the graph must be seen
LOOK_SEC = 0.5  # between two looks at the graph
DOMAINS = range(60, 100)


class LiveRunFailed(ValueError):
    """The run could not take place; it says nothing about the controller."""


@dataclass
class LiveRun:
    """What came of a run: the record, why it ended, and what was noticed on the way."""

    record: dict[str, Any]
    ending: str
    notes: list[str] = field(default_factory=list)


class Process:
    """A child with a process group of its own that is ended with everything it started."""

    def __init__(
        self, command: Sequence[str], environment: Mapping[str, str], log: IO[str], answers: str
    ) -> None:
        self._child = subprocess.Popen(
            command,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
        )
        if self._child.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # it does not listen; that is its business
                self._child.stdin.write(answers)
                self._child.stdin.close()

    @property
    def exit_code(self) -> int | None:
        return self._child.poll()

    def __enter__(self) -> Process:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()

    def end(self) -> None:
        """End the whole group: kindly, firmly, then at once."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            try:
                os.killpg(self._child.pid, number)
            except ProcessLookupError:
                break
            try:
                self._child.wait(END_WITHIN_SEC if number != signal.SIGTERM else 1.0)
            except subprocess.TimeoutExpired:
                continue
        self._child.wait()


def drive_live(
    command: str,
    course: Course,
    folder: Path,
    *,
    world: str = '',
    answers: str = '',
    real_time_factor: float = 1.0,
) -> LiveRun:
    """
    Run the simulator and the command until the run is over.

    :param answers: what is typed into the controller, for one that asks.
    :raises LiveRunFailed: when the simulator or the command cannot be started.
    """
    folder.mkdir(parents=True, exist_ok=True)
    domain = free_domain()
    environment = dict(os.environ, ROS_DOMAIN_ID=str(domain), PYTHONUNBUFFERED='1')
    environment.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    record = folder / 'record.json'
    record.unlink(missing_ok=True)
    simulator = [sys.executable, '-m', 'husky_sim.node', '--ros-args', '-p', f'record:={record}']
    simulator += ['-p', f'real_time_factor:={float(real_time_factor)}']
    simulator += ['-p', f'world:={world}'] if world else []
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    watcher = Watcher(context)
    executor = make_executor(context)
    executor.add_node(watcher)
    try:
        with (
            (folder / 'simulator.log').open('w') as log,
            Process(simulator, environment, log, '') as running,
        ):
            _await_simulator(watcher, executor, running, folder)
            controller = _start(command, environment, folder, answers)
            patience_sec = max(START_WITHIN_SEC, DISCOVERY_SEC * real_time_factor)
            referee = Referee(course, start_within_sec=patience_sec)
            run = _watch(watcher, executor, running, controller, referee, folder)
    finally:
        executor.remove_node(watcher)
        watcher.destroy_node()
        rclpy.shutdown(context=context)
    if not record.is_file():
        raise LiveRunFailed(f'the simulator left no record; see {folder / "simulator.log"}')
    run.record = load_record(record)
    record.unlink()
    return run


def _await_simulator(watcher: Watcher, executor: Any, simulator: Process, folder: Path) -> None:
    deadline = time.monotonic() + SIMULATOR_WITHIN_SEC
    while watcher.latest is None:
        executor.spin_once(timeout_sec=0.1)
        if simulator.exit_code is not None or time.monotonic() > deadline:
            tail = _tail(folder / 'simulator.log', 1)
            raise LiveRunFailed(f'the simulator did not start: {tail or "it says nothing"}')


def _start(command: str, environment: Mapping[str, str], folder: Path, answers: str) -> Process:
    try:
        with (folder / 'controller.log').open('w') as log:
            return Process(shlex.split(command), environment, log, answers)
    except (OSError, IndexError, ValueError) as error:
        raise LiveRunFailed(f'{command!r} cannot be started: {error}') from None


def _watch(
    watcher: Watcher,
    executor: Any,
    simulator: Process,
    controller: Process,
    referee: Referee,
    folder: Path,
) -> LiveRun:
    ending, seen = '', watcher.count
    heard_sec = looked_sec = time.monotonic()
    with controller:
        while not ending:
            executor.spin_once(timeout_sec=0.1)
            now = time.monotonic()
            if now - looked_sec > LOOK_SEC:
                looked_sec = now
                watcher.look()
            if watcher.count != seen:
                seen, heard_sec = watcher.count, now
                ending = referee.over(**watcher.state(), running=controller.exit_code is None)
                if not referee.started and watcher.hinting_sec(now) > HOPELESS_SEC:
                    ending = 'its commands cannot be heard'
            elif now - heard_sec > SILENCE_SEC:
                raise LiveRunFailed(f'the simulator died; see {folder / "simulator.log"}')
        exit_code = controller.exit_code
        simulator.end()  # first: the record must not show how the controller was ended
    notes = list(watcher.hints)
    if exit_code:
        how = f'exit code {exit_code}' if exit_code > 0 else signal.Signals(-exit_code).name
        tail = _tail(folder / 'controller.log', 1)
        notes.insert(0, f'it crashed ({how})' + (f': {tail}' if tail else ''))
    return LiveRun({}, ending, notes)


def free_domain() -> int:
    """Return a DDS domain nobody on this machine is in."""
    candidates = random.Random(os.getpid() + time.monotonic_ns()).sample(DOMAINS, len(DOMAINS))
    for domain in candidates:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(('', 7400 + 250 * domain + 10))  # OMG DDSI-RTPS 9.6.1.1, participant 0
            except OSError:
                continue
            return domain
    raise LiveRunFailed(f'no free DDS domain in {DOMAINS.start} to {DOMAINS.stop - 1}')


def _tail(path: Path, lines: int) -> str:
    try:
        text = path.read_text(encoding='utf-8', errors='replace').strip()
    except OSError:
        return ''
    return '\n'.join(text.splitlines()[-lines:])
