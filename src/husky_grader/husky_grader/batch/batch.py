# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Do many jobs at once; one that breaks never stops the rest.

What was done before, here or elsewhere, is not done again: see `sealed`.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import as_completed, Future
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
import shutil

from husky_runtime.processors import usable_processors

from husky_grader.batch.dask_cluster import (
    ADDRESS,
    cluster,
    outcome_from_cluster,
    start_in_cluster,
)
from husky_grader.batch.job import Job, Outcome
from husky_grader.batch.sealed import SEAL_FILE, Seals
from husky_grader.batch.workers import STALLED_CPU_SEC, workers

Start = Callable[[Job, Path, str], 'Future[Outcome]']
Result = Callable[['Future[Outcome]'], Outcome]


@dataclass(frozen=True)
class How:
    """Where jobs are done, and where results of earlier ones may lie."""

    executor: str = ''  # empty: worker processes here; dask:ADDRESS: a cluster
    jobs: int = 0  # at a time here; 0: as many as there are cores
    collect: tuple[Path, ...] = ()  # report folders of other calls, as of shards
    stalled_cpu_sec: float = STALLED_CPU_SEC


class Batch:
    """Does jobs; `done` is called with the number of each, as it comes, and its outcome."""

    def __init__(
        self,
        jobs: Sequence[Job],
        folder: Path,
        *,
        how: How = How(),  # noqa: B008  # frozen
        done: Callable[[int, Outcome], None] = lambda _number, _outcome: None,
        not_taken: Callable[[Sequence[str]], None] = lambda _names: None,
    ) -> None:
        """
        Prepare it; see `run`.

        :param folder: of all reports.
        :param not_taken: called with the names of those that another call has done, but whose
            seal is not right, before they are done here.
        :raises ValueError: if the secret for seals cannot be one.
        """
        self.unsealed = ''  # why a result could not be sealed
        self._jobs = list(jobs)
        self._folder = folder
        self._how = how
        self._done = done
        self._not_taken = not_taken
        self._seals = Seals()
        self._outcomes: dict[int, Outcome] = {}
        self._elsewhere: dict[str, list[Path]] = defaultdict(list)  # reports by their names

    def run(self) -> list[Outcome]:
        """
        Do what has not been done before; return all outcomes in the order of the jobs.

        :raises ClusterFails: when the cluster cannot be used.
        :raises ValueError: if the report of another call cannot be copied.
        """
        for folder in self._how.collect:
            for report in folder.iterdir():
                self._elsewhere[report.name].append(report)
        keys = [job.key() for job in self._jobs]
        waiting = []
        for number, (job, key) in enumerate(zip(self._jobs, keys, strict=True)):
            before = self._before(job, key)
            if before is None:
                waiting.append(number)
            else:
                self._finish(number, before)
        names = [self._jobs[number].name for number in waiting]
        if done_there := [name for name in names if self._is_done_there(name)]:
            self._not_taken(done_there)
        if waiting:
            with self._executor(len(waiting)) as (begin, result):
                futures: dict[Future[Outcome], int] = {}
                for number in waiting:
                    job = self._jobs[number]
                    futures[begin(job, self._folder / job.name, keys[number])] = number
                for future in as_completed(futures):
                    number = futures.pop(future)
                    outcome = result(future)
                    self._seal(self._jobs[number], keys[number], outcome)
                    self._finish(number, outcome)
        return [self._outcomes[number] for number in range(len(self._jobs))]

    def _before(self, job: Job, key: str) -> Outcome | None:
        """Return what the job came to before; the report of another call is copied."""
        own = self._folder / job.name
        if content := self._seals.load(own, job, key):
            return Outcome(content, remembered=True)
        for there in self._elsewhere.get(job.name, ()):
            if content := self._seals.load(there, job, key):
                job.forget(own)
                _copy_report(there, own)
                return Outcome(content, remembered=True)
        return None

    def _is_done_there(self, name: str) -> bool:
        return any((there / SEAL_FILE).exists() for there in self._elsewhere.get(name, ()))

    @contextmanager
    def _executor(self, most: int) -> Iterator[tuple[Start, Result]]:
        how = self._how
        if how.executor.startswith(ADDRESS):
            with cluster(how.executor.removeprefix(ADDRESS)) as executor:
                yield (
                    lambda job, folder, key: start_in_cluster(executor, job, folder, key),
                    outcome_from_cluster,
                )
        else:
            count = how.jobs or usable_processors()
            with workers(min(count, most), how.stalled_cpu_sec) as start:
                yield lambda job, folder, _key: start(job, folder), Future[Outcome].result

    def _seal(self, job: Job, key: str, outcome: Outcome) -> None:
        if outcome.content is not None:
            try:
                self._seals.seal(self._folder / job.name, job, key)
            except OSError as error:
                self.unsealed = self.unsealed or str(error.strerror)

    def _finish(self, number: int, outcome: Outcome) -> None:
        self._outcomes[number] = outcome
        self._done(number, outcome)


def _copy_report(there: Path, own: Path) -> None:
    """
    Copy a report to where files of a person may lie; its seal last, as one is written.

    :raises ValueError: if it cannot be copied, as where the disk is full.
    """

    def seal(folder: str, _names: Sequence[str]) -> list[str]:
        return [SEAL_FILE] if Path(folder) == there else []

    try:
        shutil.copytree(there, own, symlinks=True, ignore=seal, dirs_exist_ok=True)
        shutil.copyfile(there / SEAL_FILE, own / SEAL_FILE)
    except OSError as error:
        # One of shutil has a list: of each file whence, whereto and why not.
        why = error.args[0][0][-1] if isinstance(error, shutil.Error) else error.strerror
        raise ValueError(
            f'--collect: {there} cannot be copied to {own}: {why}; mend that, then the same '
            'command goes on'
        ) from None
