# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade many files with all cores; one that breaks never stops the rest.

Workers are processes of their own, each with a pipe. One that crashes or takes too long costs its
file, and another takes its place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import csv
from dataclasses import dataclass
import multiprocessing
from multiprocessing.connection import Connection, wait
import os
from pathlib import Path
import signal
import time
from typing import Any

from husky_driver.grading import grade_file, Graded, graded_before, key_of, remember

FILE_TIMEOUT_SEC = 300.0
POLL_SEC = 0.1

COLUMNS = (
    *('file', 'score', 'passed', 'completed', 'waypoints_reached', 'waypoints_total'),
    *('collisions', 'cross_track_rms_m', 'cross_track_max_m', 'min_clearance_m'),
    *('path_length_m', 'driven_m', 'sim_time_sec', 'trajectory_sha256', 'reasons'),
)


def names_of(files: Sequence[str]) -> list[str]:
    """Return a short name for each file, no two alike."""
    stems = [Path(file).stem for file in files]
    if len(set(stems)) == len(stems):
        return stems
    parts = [Path(file).resolve().with_suffix('').parts for file in files]
    depth = 1
    while depth < max(map(len, parts)) and len({p[-depth:] for p in parts}) < len(parts):
        depth += 1
    return ['_'.join(p[-depth:]).replace(os.sep, '') for p in parts]


@dataclass
class _Worker:
    process: Any
    pipe: Connection
    file: int | None = None
    since_sec: float = 0.0


class Classroom:
    """Grades files; `done` is called with each result as it comes."""

    def __init__(
        self,
        files: Sequence[str],
        folder: Path,
        *,
        world: str = '',
        jobs: int = 0,
        done: Callable[[int, Graded], None] = lambda _number, _graded: None,
        timeout_sec: float = FILE_TIMEOUT_SEC,
    ) -> None:
        self.files = list(files)
        self.names = names_of(files)
        self.results: dict[int, Graded] = {}
        self._folder = folder
        self._world = world
        self._done = done
        self._timeout_sec = timeout_sec
        self._keys = [key_of(file, world) for file in files]
        self._jobs = jobs or len(os.sched_getaffinity(0))
        self._context = multiprocessing.get_context('spawn')

    def grade(self) -> list[Graded]:
        """Grade what has not been graded before; return all results in the order of the files."""
        waiting = []
        for i, file in enumerate(self.files):
            before = graded_before(file, self._folder / self.names[i], self._keys[i])
            if before is None:
                waiting.append(i)
            else:
                self._finish(i, before, fresh=False)
        workers: list[_Worker] = []
        try:
            workers += [self._hire() for _ in range(min(self._jobs, len(waiting)))]
            self._work(workers, waiting[::-1])
        finally:
            for worker in workers:
                worker.process.kill()
                worker.process.join()
                worker.pipe.close()
        return [self.results[i] for i in range(len(self.files))]

    def _hire(self) -> _Worker:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(theirs,), daemon=True)
        process.start()
        theirs.close()
        return _Worker(process, ours)

    def _work(self, workers: list[_Worker], waiting: list[int]) -> None:
        while True:
            for worker in workers:
                if worker.file is None and waiting:
                    self._give(worker, waiting.pop())
            busy = [worker for worker in workers if worker.file is not None]
            if not busy:
                return
            ready = wait([worker.pipe for worker in busy], timeout=POLL_SEC)
            for worker in busy:
                if worker.pipe in ready:
                    self._receive(worker)
                elif time.monotonic() - worker.since_sec > self._timeout_sec:
                    self._lose(worker, f'took longer than {self._timeout_sec:g} s')
                if not worker.process.is_alive() and worker.file is None and waiting:
                    workers[workers.index(worker)] = self._hire()

    def _give(self, worker: _Worker, number: int) -> None:
        worker.file, worker.since_sec = number, time.monotonic()
        worker.pipe.send((self.files[number], self._folder / self.names[number], self._world))

    def _receive(self, worker: _Worker) -> None:
        try:
            graded = worker.pipe.recv()
        except (EOFError, OSError):
            self._lose(worker, 'the grader itself crashed on this file')
            return
        self._finish(self._freed(worker), graded)

    def _lose(self, worker: _Worker, why: str) -> None:
        worker.process.kill()
        worker.process.join()
        worker.pipe.close()
        number = self._freed(worker)
        self._finish(number, Graded(self.files[number], None, why, refused=why))

    def _freed(self, worker: _Worker) -> int:
        number, worker.file = worker.file, None
        if number is None:
            raise RuntimeError('a worker without a file has answered')
        return number

    def _finish(self, number: int, graded: Graded, *, fresh: bool = True) -> None:
        if fresh and graded.report is not None:
            remember(self._folder / self.names[number], self._keys[number])
        self.results[number] = graded
        self._done(number, graded)


def _serve(pipe: Connection) -> None:
    """Grade what comes through the pipe, until it closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides when it is over
    while True:
        try:
            file, folder, world = pipe.recv()
        except (EOFError, OSError):
            return
        try:
            graded = grade_file(file, folder, world=world)
        except Exception as error:  # whatever it is, it must not stop the others
            why = f'{file}: the grader failed: {type(error).__name__}: {error}'
            graded = Graded(file, None, why, refused=why)
        pipe.send(graded)


def write_csv(path: Path, results: Sequence[Graded]) -> None:
    """Write one line a file, for a spreadsheet."""
    part = path.with_name(f'.{path.name}.part')
    with part.open('w', newline='', encoding='utf-8') as stream:
        writer = csv.writer(stream)
        writer.writerow(COLUMNS)
        writer.writerows(_row(graded) for graded in results)
    part.replace(path)


def _row(graded: Graded) -> list[object]:
    report = graded.report or {}
    given = {
        'file': graded.file,
        'score': round(graded.score, 2),
        'passed': graded.passed,
        'collisions': graded.collisions,
        'reasons': graded.refused or '; '.join(report.get('reasons', [])),
    }
    values = [given.get(column, report.get(column, '')) for column in COLUMNS]
    return [_plain(value) for value in values]


def _plain(value: object) -> object:
    """Keep a spreadsheet from taking text for a formula."""
    if isinstance(value, str):
        text = ' '.join(value.split())
        return f"'{text}" if text[:1] in ('=', '+', '-', '@') else text
    return '' if value is None else value
