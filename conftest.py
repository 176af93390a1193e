# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What every test relies on.

`./lab test` runs two tests at a time for each processor, four at least and eight at most: most
wait for a clock more than they compute. With `CI` set it is one for each, two at least: nobody
waits there, and on a shared machine in a slow hour all compute, so that what has to end in time
would not. The tests of a file stay in one process. Each test that uses DDS has a domain of its
own, see husky_runtime.domains.
"""

from collections.abc import Iterator
import gc
import os
from pathlib import PurePosixPath
import signal
from typing import Any

from husky_runtime.processors import usable_processors
from hypothesis import HealthCheck, settings
import pytest


def _leave(*_: object) -> None:
    os._exit(pytest.ExitCode.INTERRUPTED)


# How long an example takes is a matter of the machine.
settings.register_profile('lab', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('lab')

os.environ['MUJOCO_GL'] = 'disabled'  # as in the lab's programs, see husky_runtime.start

# Until a test runs there is nothing to tell of, but from amid which import pytest was torn.
signal.signal(signal.SIGINT, _leave)
signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))
# Under nohup the tests go on, but the programs that they start hear of a terminal that is closed.
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN or 'PYTEST_XDIST_WORKER' in os.environ:
    signal.signal(signal.SIGHUP, lambda *_: None)


def pytest_runtest_logstart() -> None:
    """Let an interrupt from now on end the tests, and pytest tell what has failed so far."""
    # Also where it was ignored, as in a shell's background job: the tests send it to programs.
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_finish() -> None:
    """Keep thousands of tests, which stay to the end, out of each collection of garbage."""
    gc.freeze()


@pytest.hookimpl(wrapper=True)
def pytest_sessionstart() -> Iterator[None]:
    """Start the processes that run the tests with interrupts held back until they can take one."""
    signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Tell how many tests run at a time where nobody says so."""
    of_each = 1 if os.environ.get('CI') else 2
    return min(of_each * max(2, usable_processors()), 8)


# Files whose tests share what takes long: a browser that draws without a graphics processor, which
# fills a core, and a build of every package.
TOGETHER = {'test_view': 'in a browser', 'test_packages': 'built', 'test_workspace': 'built'}


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Keep the tests of a file together, and those of some files."""
    from xdist.scheduler import LoadScopeScheduling

    class ByFile(LoadScopeScheduling):  # type: ignore[misc]
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition('::')[0]
            name = PurePosixPath(file).name
            return next(
                (group for start, group in TOGETHER.items() if name.startswith(start)), file
            )

        def _reschedule(self, node: Any) -> None:
            # A process runs a test once it knows the next one. After another one has died it may
            # be given a single test, or files of which all is done, and wait for ever.
            super()._reschedule(node)
            while (
                self.workqueue
                and not node.shutting_down
                and self._pending_of(self.assigned_work[node]) < 2
            ):
                super()._reschedule(node)

    return ByFile(config, log)
