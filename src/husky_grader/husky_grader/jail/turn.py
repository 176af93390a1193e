# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Submissions wait for each other where the sandbox cannot keep their programs apart."""

from collections.abc import Iterator
from contextlib import closing, contextmanager
import time

from husky_runtime.domains import Lock

from husky_grader.jail.sandbox import Sandbox

_ASKED_AGAIN_SEC = 0.2


@contextmanager
def own_turn(sandbox: Sandbox) -> Iterator[None]:
    """Wait until no other submission runs on this machine in such a sandbox, if that matters."""
    if sandbox.one_at_a_time:
        with closing(_lock(f'husky_grader_in_sandbox_{sandbox.name}')):
            yield
    else:
        yield


def _lock(name: str) -> Lock:
    while True:
        try:
            return Lock(name)
        except BlockingIOError:
            time.sleep(_ASKED_AGAIN_SEC)
