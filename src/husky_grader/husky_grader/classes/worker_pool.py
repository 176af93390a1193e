# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade many files with all cores; one that breaks never stops the rest.

Workers are processes of their own, each with a pipe; the kernel ends them with their parent. One
that crashes costs its file, and another takes its place. So does one that hangs, which its own
processor time tells, however busy the machine is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
import csv
from dataclasses import dataclass
from itertools import count
import multiprocessing
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
import os
from pathlib import Path
import re
import signal
from typing import Any

from husky_course.printable import printable
from husky_runtime.parent_death import die_with_parent

from husky_grader.classes.grading import grade_file, Graded, key_of
from husky_grader.classes.memory import Memory
from husky_grader.report.atomic_file import replacing
from husky_grader.report.report import REPORT_FILES

STALLED_CPU_SEC = 60.0

_OUR_FILES = ('grades.csv', '.grades.part.csv', *REPORT_FILES)
_LONGEST_NAME = 100  # bytes

COLUMNS = (
    *('file', 'score', 'passed', 'completed', 'waypoints_reached', 'waypoints_total'),
    *('collisions', 'cross_track_rms_m', 'cross_track_max_m', 'min_clearance_m'),
    *('path_length_m', 'driven_m', 'sim_time_sec', 'trajectory_sha256', 'reasons'),
)


def names_of(files: Sequence[str]) -> list[str]:
    """Return for each file the name of a folder of its own: short, and harmless everywhere."""
    stems = [Path(file).stem for file in files]
    if len(set(stems)) < len(stems):
        paths = [Path(file).absolute() for file in files]
        parts = [(*path.parent.parts[1:], path.stem) for path in paths]
        depth = 1
        while depth < max(map(len, parts)) and len({p[-depth:] for p in parts}) < len(parts):
            depth += 1
        stems = ['_'.join(p[-depth:]) for p in parts]
    taken = {name.casefold() for name in _OUR_FILES}
    return [_alone(_harmless(stem), taken) for stem in stems]


def _harmless(stem: str) -> str:
    name = re.sub(r'[^\w .+()=,@-]', '_', stem, flags=re.UNICODE).strip(' .')
    return name.encode()[:_LONGEST_NAME].decode(errors='ignore') or 'unnamed'


def _alone(name: str, taken: set[str]) -> str:
    """Add a number where another file, or one of ours, has the name; case does not count."""
    numbered = (name if number == 1 else f'{name}_{number}' for number in count(1))
    free = next(candidate for candidate in numbered if candidate.casefold() not in taken)
    taken.add(free.casefold())
    return free


@dataclass
class _Worker:
    process: Any
    pipe: Connection
    file: int | None = None


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
        stalled_cpu_sec: float = STALLED_CPU_SEC,
    ) -> None:
        self.files = list(files)
        self.names = names_of(files)
        self.results: dict[int, Graded] = {}
        self.unsealed = ''  # why a report was not remembered
        self._folder = folder
        self._world = world
        self._done = done
        self._stalled_cpu_sec = stalled_cpu_sec
        self._memory = Memory()
        self._keys = [key_of(file, world) for file in files]
        self._jobs = jobs or len(os.sched_getaffinity(0))
        self._context = multiprocessing.get_context('spawn')

    def grade(self) -> list[Graded]:
        """Grade what has not been graded before; return all results in the order of the files."""
        waiting = []
        for i, file in enumerate(self.files):
            before = self._memory.recall(self._folder / self.names[i], self._keys[i])
            if before is None:
                waiting.append(i)
            else:
                self._finish(i, Graded(file, before, ''), fresh=False)
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
        # The parent decides when it is over: a worker ignores Ctrl-C, from its start on. That the
        # parent does so for this moment too loses nothing: the one who waits presses again.
        resource_tracker.ensure_running()  # has a start of its own
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            process.start()
        finally:
            signal.signal(signal.SIGINT, before)
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
            ready = wait([worker.pipe for worker in busy])
            for worker in busy:
                if worker.pipe in ready and not self._receive(worker) and waiting:
                    workers[workers.index(worker)] = self._hire()

    def _give(self, worker: _Worker, number: int) -> None:
        worker.file = number
        folder = self._folder / self.names[number]
        # One that has ended closes the pipe, which is noticed when its answer is read.
        with suppress(OSError):
            worker.pipe.send((self.files[number], folder, self._world, self._stalled_cpu_sec))

    def _receive(self, worker: _Worker) -> bool:
        """Take what a worker answers; tell whether it can go on."""
        try:
            graded = worker.pipe.recv()
        except (EOFError, OSError):
            self._lose(worker)
            return False
        self._finish(self._freed(worker), graded)
        return True

    def _lose(self, worker: _Worker) -> None:
        worker.process.kill()
        worker.process.join()
        worker.pipe.close()
        number, why = self._freed(worker), 'the grader itself crashed on this file'
        if worker.process.exitcode == -signal.SIGPROF:
            why = (
                f'the grader hung: {self._stalled_cpu_sec:g} s of processor time without a '
                'second of simulated time'
            )
        self._finish(number, Graded(self.files[number], None, why, refused=why))

    def _freed(self, worker: _Worker) -> int:
        number, worker.file = worker.file, None
        if number is None:
            raise RuntimeError('a worker without a file has answered')
        return number

    def _finish(self, number: int, graded: Graded, *, fresh: bool = True) -> None:
        if fresh and graded.report is not None:
            try:
                self._memory.remember(self._folder / self.names[number], self._keys[number])
            except OSError as error:
                self.unsealed = self.unsealed or str(error.strerror)
        self.results[number] = graded
        self._done(number, graded)


def _serve(pipe: Connection) -> None:
    """Grade what comes through the pipe, until it closes."""
    die_with_parent(signal.SIGKILL)
    while True:
        try:
            file, folder, world, stalled_cpu_sec = pipe.recv()
            pipe.send(_graded(file, folder, world, stalled_cpu_sec))
        except (EOFError, OSError):
            return


def _graded(file: str, folder: Path, world: str, stalled_cpu_sec: float) -> Graded:
    """Grade a file; a second of simulated time must pass again and again, or SIGPROF ends us."""

    def each_second() -> None:
        signal.setitimer(signal.ITIMER_PROF, stalled_cpu_sec)  # of this process's own work

    each_second()
    try:
        return grade_file(file, folder, world=world, each_second=each_second)
    except OSError as error:
        why = f'its report cannot be written: {error.strerror}'
        return Graded(file, None, why, refused=why, unwritten=True)
    except Exception as error:  # whatever it is, it must not stop the others
        why = f'{file}: the grader failed: {type(error).__name__}: {error}'
        return Graded(file, None, why, refused=why)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def write_csv(path: Path, results: Sequence[Graded]) -> None:
    """Write one line a file, for a spreadsheet."""
    with replacing(path) as part, part.open('w', newline='', encoding='utf-8') as stream:
        writer = csv.writer(stream)
        writer.writerow(COLUMNS)
        writer.writerows(_row(graded) for graded in results)


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
        text = printable(' '.join(value.split()))
        return f"'{text}" if text[:1] in ('=', '+', '-', '@') else text
    return '' if value is None else value
