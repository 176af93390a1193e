# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Worker processes of this machine.

One that crashes costs its job, and another takes its place. So does one that hangs, which its own
processor time tells, however busy the machine is.
"""

from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
import multiprocessing
from multiprocessing import resource_tracker
from pathlib import Path
import signal

from husky_runtime.parent_death import die_with_parent
from pebble import ProcessExpired, ProcessPool

from husky_grader.batch.job import Job, Outcome

STALLED_CPU_SEC = 60.0


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


def start(
    pool: ProcessPool, job: Job, folder: Path, stalled_cpu_sec: float = STALLED_CPU_SEC
) -> 'Future[Outcome]':
    """
    Have a worker do a job.

    :param folder: of the job's report.
    :param stalled_cpu_sec: how much processor time it may take before it says that it is alive.
    """
    future: Future[Outcome] = pool.schedule(_run, args=(job, folder, stalled_cpu_sec))
    return future


def outcome_of(future: 'Future[Outcome]', stalled_cpu_sec: float = STALLED_CPU_SEC) -> Outcome:
    """Return what a job came to, also where its worker has crashed."""
    try:
        return future.result()
    except ProcessExpired as error:
        if error.exitcode == -signal.SIGPROF:
            return Outcome(
                None,
                f'the grader hung: {stalled_cpu_sec:g} s of processor time without progress',
            )
        return Outcome(None, 'the grader itself crashed on this one')


def _begin_worker() -> None:
    die_with_parent(signal.SIGKILL)
    # The pool tells a worker to end and sends SIGTERM as well. A handler in Python is gone by then
    # if the worker is quick, and Python prints a traceback.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _run(job: Job, folder: Path, stalled_cpu_sec: float) -> Outcome:
    """Do a job; SIGPROF ends this process when the job shows no sign of life."""

    def alive() -> None:
        signal.setitimer(signal.ITIMER_PROF, stalled_cpu_sec)  # of this process's own work

    alive()
    try:
        return job.run(folder, alive)
    except OSError as error:
        return Outcome(None, f'its report cannot be written: {error.strerror}', unwritten=True)
    except Exception as error:  # whatever it is, it must not stop the others
        return Outcome(None, f'{job.name}: the grader failed: {type(error).__name__}: {error}')
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
