# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What every test relies on.

`./lab test` runs two tests at a time: one alone leaves half of two cores idle. Each folder of
tests stays in one process. Each test that uses DDS has a domain of its own, see
husky_runtime.domains.
"""

from collections.abc import Iterator
import os
from pathlib import PurePosixPath
import signal
from typing import Any

import pytest


def _leave(*_: object) -> None:
    os._exit(pytest.ExitCode.INTERRUPTED)


# Until a test runs there is nothing to tell of, but from amid which import pytest was torn.
signal.signal(signal.SIGINT, _leave)
signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


def pytest_runtest_logstart() -> None:
    """Let an interrupt from now on end the tests, and pytest tell what has failed so far."""
    # Also where it was ignored, as in a shell's background job: the tests send it to programs.
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(wrapper=True)
def pytest_sessionstart() -> Iterator[None]:
    """Start the processes that run the tests with interrupts held back until they can take one."""
    signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Keep the tests of a folder together; those in the browser are a third of theirs."""
    from xdist.scheduler import LoadScopeScheduling

    class ByFolder(LoadScopeScheduling):  # type: ignore[misc]
        def _split_scope(self, nodeid: str) -> str:
            path = PurePosixPath(nodeid.partition('::')[0])
            return 'view' if path.name.startswith('test_view') else str(path.parent)

    return ByFolder(config, log)
