# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Workers of a Dask cluster, which has this lab and the class's folders at the same places.

A job runs there in a process of its own, so that a crash costs the job and not the worker. Dask
gives the jobs of a worker that is lost to another one.
"""

from collections.abc import Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
import os
from pathlib import Path

from husky_grader.batch.job import Job, Outcome
from husky_grader.batch.workers import workers

CONNECT_WITHIN_SEC = 20.0
ADDRESS = 'dask:'
"""Begins the name of an executor that is a cluster; the address of its scheduler follows."""


class ClusterFails(ValueError):
    """The cluster cannot be used; the message is one line for a person."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """
    Connect to a scheduler.

    :param address: as Dask has it: tcp://HOST:PORT, or a scheduler file.
    :raises ClusterFails: if nobody answers there, or Dask is not installed.
    """
    try:
        from distributed import Client
        from distributed.comm import get_address_host_port
    except ImportError:
        raise ClusterFails(
            f'{ADDRESS}{address} needs distributed, which is not installed here: '
            './lab exec pip install distributed'
        ) from None
    try:
        where = {'scheduler_file': address}
        if not Path(address).is_file():
            # A client with an address that it cannot read ends after 40 s, with a traceback.
            get_address_host_port(address)
            where = {'address': address}
        client = Client(**where, timeout=CONNECT_WITHIN_SEC, set_as_default=False)
    except (OSError, ValueError) as error:
        why = str(error).splitlines()[0] if str(error) else 'no answer'
        raise ClusterFails(
            f'{ADDRESS}{address}: {why}; start one: ./lab exec dask scheduler, and on each '
            'machine ./lab exec dask worker tcp://HOST:8786'
        ) from None
    with client:
        yield client.get_executor()


def start_in_cluster(executor: Executor, job: Job, folder: Path, key: str) -> 'Future[Outcome]':
    """
    Have a worker of the cluster do a job.

    :param key: of the job here.
    """
    return executor.submit(_run_there, job, folder.absolute(), key)


def outcome_from_cluster(future: 'Future[Outcome]') -> Outcome:
    """
    Return what a job came to.

    :raises ClusterFails: if its worker has not what we have, or the cluster is gone.
    """
    from distributed import CancelledError, KilledWorker

    try:
        return future.result()
    except KilledWorker:
        return Outcome(None, 'each worker that began with this one was lost')
    except (CancelledError, OSError) as error:
        raise ClusterFails(f'the cluster is gone: {error}') from None


def _run_there(job: Job, folder: Path, key: str) -> Outcome:
    from husky_grader.batch.key import versions

    if job.key() != key:
        have = ', '.join(f'{name} {value}' for name, value in versions().items())
        raise ClusterFails(
            f'a worker on {os.uname().nodename} has another lab, {have}, or does not see '
            f'{job.name}: give all machines the same commit, versions and folders'
        )
    with workers(1) as start:
        return start(job, folder).result()
