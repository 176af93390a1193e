# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Worker processes of this machine.

One that crashes costs its job, and another takes its place. So does one that hangs, which its own
processor time tells, however busy the machine is. The job of one that is ended from outside is
undone.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
import multiprocessing
from multiprocessing import parent_process, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
import os
from pathlib import Path
from queue import SimpleQueue
import signal
import tempfile
from threading import current_thread, Lock, main_thread

from husky_runtime.parent_death import die_with_parent

from husky_grader.batch.job import Job, Outcome
from husky_grader.batch.temporary_folder import TemporaryFolder
from husky_grader.run.diagnosis import how_ended

STALLED_CPU_SEC = 60.0

_FROM_OUTSIDE = (-signal.SIGKILL, -signal.SIGTERM, -signal.SIGINT, -signal.SIGHUP)
"""Exit codes of a worker that has done nothing wrong."""

_SPAWN = multiprocessing.get_context('spawn')
_CHANGING = Lock()
"""Processes are started and reaped one at a time: a start reaps all children that have ended."""

_SAFE_PATH = 'PYTHONSAFEPATH'
"""
Processes start by `python -c`, which looks for modules in the working directory first.

Somebody may have handed in a multiprocessing.py there. Python has this since 3.11.
"""


@contextmanager
def workers(
    count: int, stalled_cpu_sec: float = STALLED_CPU_SEC
) -> Iterator[Callable[[Job, Path], 'Future[Outcome]']]:
    """
    Open workers that never see Ctrl-C; at the end none is left, nor a temporary file of theirs.

    What it gives has a worker do a job, whose report goes to the folder.

    :param stalled_cpu_sec: how much processor time a job may take before it says that it is alive.
    """
    # Of multiprocessing: it starts with the first process otherwise, and unblocks SIGINT there.
    with _CHANGING, _safe_path():
        resource_tracker.ensure_running()
    place = TemporaryFolder()
    place.path.chmod(0o711)  # the user of a jail passes it, as it passes /tmp
    all_workers = [_Worker(str(place.path)) for _ in range(count)]
    idle: SimpleQueue[_Worker] = SimpleQueue()
    for worker in all_workers:
        idle.put(worker)

    def do(job: Job, folder: Path) -> Outcome:
        worker = idle.get()
        try:
            return worker.do(job, folder, stalled_cpu_sec)
        finally:
            idle.put(worker)

    threads = ThreadPoolExecutor(count, initializer=_block_interrupt)
    try:
        yield lambda job, folder: threads.submit(do, job, folder)
    finally:
        with _interrupts_deferred():  # a second one would leave workers to their jobs
            threads.shutdown(wait=False, cancel_futures=True)
            for worker in all_workers:
                worker.kill()
            for worker in all_workers:
                worker.reap()
            threads.shutdown()
            place.remove()


class _Worker:
    """
    A process that does one job after another, and the next process where it has died.

    :param place: the folder for its temporary files.
    """

    def __init__(self, place: str) -> None:
        self._place = place
        self._process: SpawnProcess | None = None
        self._pipe: Connection
        self._ended = False

    def do(self, job: Job, folder: Path, stalled_cpu_sec: float) -> Outcome:
        """Have a job done; the calling thread must live as long as the worker."""
        try:
            process, pipe = self._living()
        except OSError as error:  # as where no more processes are allowed
            why = f'the grader got no process for it: {error.strerror}'
            return Outcome(None, why, undone=True)
        with suppress(EOFError, OSError):  # it dies while it reads or writes
            pipe.send((job, folder, stalled_cpu_sec))
            wait([pipe, process.sentinel])
            if pipe.poll():
                outcome: Outcome = pipe.recv()
                return outcome
        code = _end_of(process)
        if code in _FROM_OUTSIDE:
            return Outcome(None, f'its grading was ended by {how_ended(code)}', undone=True)
        if code == -signal.SIGPROF:
            return Outcome(
                None,
                f'the grader hung: {stalled_cpu_sec:g} s of processor time without progress',
            )
        return Outcome(None, 'the grader itself crashed on this one')

    def kill(self) -> None:
        """Kill it, whatever it does; it does no job any more."""
        with _CHANGING:
            self._ended = True
        if self._process is not None:
            self._process.kill()

    def reap(self) -> None:
        """Wait until it has ended."""
        if self._process is not None:
            _end_of(self._process)

    def _living(self) -> tuple[SpawnProcess, Connection]:
        """Return the process and our end of the pipe to it; a new one where it has ended."""
        with _CHANGING:
            if self._ended:
                raise OSError('the workers have ended')
            if self._process is None or wait([self._process.sentinel], 0.0):
                self._pipe, its = _SPAWN.Pipe()
                with its, _safe_path():
                    process = _SPAWN.Process(target=_serve, args=(its, self._place), daemon=True)
                    process.start()
                self._process = process
            return self._process, self._pipe


@contextmanager
def _safe_path() -> Iterator[None]:
    """Let programs that are started meanwhile import nothing from the working directory."""
    before = os.environ.get(_SAFE_PATH)
    os.environ[_SAFE_PATH] = '1'
    try:
        yield
    finally:
        os.environ.pop(_SAFE_PATH)
        if before is not None:
            os.environ[_SAFE_PATH] = before


def _end_of(process: SpawnProcess) -> int | None:
    """Wait for its end; return its exit code."""
    wait([process.sentinel])
    with _CHANGING:
        process.join()
    return process.exitcode


def _block_interrupt() -> None:
    """Block it in this thread: the processes that it starts inherit that."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


@contextmanager
def _interrupts_deferred() -> Iterator[None]:
    """Let an interrupt act at the end. To block it would take all threads, those of numpy, too."""
    if current_thread() is not main_thread():  # no interrupt acts there
        yield
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


def _serve(pipe: Connection, place: str) -> None:
    os.environ.pop(_SAFE_PATH, None)  # what is built here may rely on its own folder
    # A Python of the lab unblocks it at its start: see interrupt_while_loading in underlay.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent(signal.SIGKILL)
    parent = parent_process()
    if parent is not None and parent.pid != os.getppid():
        return  # it was killed before: nobody waits for the result, and the next call may be here
    tempfile.tempdir = place
    with suppress(EOFError):  # the other end is closed
        while True:
            pipe.send(_run(*pipe.recv()))


def _run(job: Job, folder: Path, stalled_cpu_sec: float) -> Outcome:
    """Do a job; SIGPROF ends this process when the job shows no sign of life."""

    def alive() -> None:
        signal.setitimer(signal.ITIMER_PROF, stalled_cpu_sec)  # of this process's own work

    alive()
    try:
        return job.run(folder, alive)
    except OSError as error:
        return Outcome(None, f'its report cannot be written: {error.strerror}', undone=True)
    except Exception as error:  # whatever it is, it must not stop the others
        return Outcome(None, f'{job.name}: the grader failed: {type(error).__name__}: {error}')
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
