# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade many files with all cores; one that breaks never stops the rest.

A worker process that crashes costs its file, and another takes its place. So does one that hangs,
which its own processor time tells, however busy the machine is.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import as_completed, Future
from contextlib import contextmanager
import multiprocessing
from multiprocessing import resource_tracker
import os
from pathlib import Path
import signal

from husky_runtime.parent_death import die_with_parent
from pebble import ProcessExpired, ProcessPool

from husky_grader.batch.cache import Cache, key_of
from husky_grader.batch.tables import names_of
from husky_grader.grading import Grade, grade_file

STALLED_CPU_SEC = 60.0


class BatchGrader:
    """Grades files; `done` is called with each result as it comes."""

    def __init__(
        self,
        files: Sequence[str],
        folder: Path,
        *,
        world: str = '',
        jobs: int = 0,
        done: Callable[[int, Grade], None] = lambda _number, _grade: None,
        stalled_cpu_sec: float = STALLED_CPU_SEC,
    ) -> None:
        self.files = list(files)
        self.names = names_of(files)
        self.results: dict[int, Grade] = {}
        self.unsealed = ''  # why a report could not be sealed
        self._folder = folder
        self._world = world
        self._done = done
        self._stalled_cpu_sec = stalled_cpu_sec
        self._cache = Cache()
        self._keys = [key_of(file, world) for file in files]
        self._jobs = jobs or len(os.sched_getaffinity(0))

    def grade(self) -> list[Grade]:
        """Grade what has not been graded before; return all results in the order of the files."""
        waiting = []
        for number, file in enumerate(self.files):
            before = self._cache.load(self._folder / self.names[number], self._keys[number])
            if before is None:
                waiting.append(number)
            else:
                self._finish(number, Grade(file, before, ''))
        if waiting:
            self._grade(waiting)
        return [self.results[number] for number in range(len(self.files))]

    def _grade(self, waiting: Sequence[int]) -> None:
        with workers(min(self._jobs, len(waiting))) as pool:
            futures: dict[Future[Grade], int] = {}
            for number in waiting:
                folder = self._folder / self.names[number]
                job = (self.files[number], folder, self._world, self._stalled_cpu_sec)
                futures[pool.schedule(_grade_in_worker, args=job)] = number
            for future in as_completed(futures):
                number = futures.pop(future)
                grade = self._result(number, future)
                self._seal(number, grade)
                self._finish(number, grade)

    def _result(self, number: int, future: Future[Grade]) -> Grade:
        try:
            return future.result()
        except ProcessExpired as error:
            why = 'the grader itself crashed on this file'
            if error.exitcode == -signal.SIGPROF:
                why = (
                    f'the grader hung: {self._stalled_cpu_sec:g} s of processor time without a '
                    'second of simulated time'
                )
            return Grade(self.files[number], None, why, refused=why)

    def _seal(self, number: int, grade: Grade) -> None:
        if grade.report is not None:
            try:
                self._cache.seal(self._folder / self.names[number], self._keys[number])
            except OSError as error:
                self.unsealed = self.unsealed or str(error.strerror)

    def _finish(self, number: int, grade: Grade) -> None:
        self.results[number] = grade
        self._done(number, grade)


@contextmanager
def workers(count: int) -> Iterator[ProcessPool]:
    """
    Open a pool of worker processes that never see Ctrl-C; at the end none is left.

    Threads and processes inherit which signals are blocked: the workers from this thread, and
    those that take their places from the pool's threads.
    """
    pool = ProcessPool(
        max_workers=count,
        initializer=_begin_worker,
        context=multiprocessing.get_context('spawn'),
    )
    resource_tracker.ensure_running()  # its start would unblock the signal again
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        try:
            if not pool.active:  # this starts it
                raise RuntimeError('the pool of workers did not start')
        finally:
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        yield pool
    finally:
        pool.stop()
        pool.join()


def _begin_worker() -> None:
    die_with_parent(signal.SIGKILL)
    # The pool tells a worker to end and sends SIGTERM as well. A handler in Python is gone by then
    # if the worker is quick, and Python prints a traceback.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _grade_in_worker(file: str, folder: Path, world: str, stalled_cpu_sec: float) -> Grade:
    """Grade a file; SIGPROF ends this process when simulated time does not pass."""

    def each_second() -> None:
        signal.setitimer(signal.ITIMER_PROF, stalled_cpu_sec)  # of this process's own work

    each_second()
    try:
        return grade_file(file, folder, world=world, each_second=each_second)
    except OSError as error:
        why = f'its report cannot be written: {error.strerror}'
        return Grade(file, None, why, refused=why, unwritten=True)
    except Exception as error:  # whatever it is, it must not stop the others
        why = f'{file}: the grader failed: {type(error).__name__}: {error}'
        return Grade(file, None, why, refused=why)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
