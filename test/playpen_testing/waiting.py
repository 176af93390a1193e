# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Wait for a fact with a deadline, and say what was missing."""

from collections.abc import Callable
import time

POLL_SEC = 0.01


def wait_until(
    fact: Callable[[], object], *, what: str | Callable[[], str], timeout_sec: float = 10.0
) -> None:
    """
    Return as soon as the fact holds.

    :param what: what is waited for, in words; a callable is asked when time is up.
    :raises AssertionError: if it does not hold within the timeout.
    """
    deadline = time.monotonic() + timeout_sec
    while not fact():
        if time.monotonic() > deadline:
            words = what if isinstance(what, str) else what()
            raise AssertionError(f'not within {timeout_sec} s: {words}')
        time.sleep(POLL_SEC)
