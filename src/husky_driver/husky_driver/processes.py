# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Children that are ended with everything they started, and a DDS domain for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import contextlib
import os
from pathlib import Path
import random
import signal
import socket
import subprocess
import time
from types import TracebackType
from typing import IO

END_WITHIN_SEC = 5.0
DOMAINS = range(85, 102)


class Process:
    """A child with a process group of its own that is ended with everything it started."""

    def __init__(
        self, command: Sequence[str], environment: Mapping[str, str], log: IO[str], answers: str
    ) -> None:
        self._child = subprocess.Popen(
            command,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
        )
        if self._child.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # it does not listen; that is its business
                self._child.stdin.write(answers)
                self._child.stdin.close()

    @property
    def exit_code(self) -> int | None:
        return self._child.poll()

    def __enter__(self) -> Process:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()

    def end(self) -> None:
        """End the whole group: kindly, firmly, then at once."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            try:
                os.killpg(self._child.pid, number)
            except ProcessLookupError:
                break
            try:
                self._child.wait(END_WITHIN_SEC if number != signal.SIGTERM else 1.0)
            except subprocess.TimeoutExpired:
                continue
        self._child.wait()


def free_domain() -> int:
    """Return a DDS domain nobody on this machine is in."""
    candidates = random.Random(os.getpid() + time.monotonic_ns()).sample(DOMAINS, len(DOMAINS))
    for domain in candidates:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(('', 7400 + 250 * domain + 10))  # OMG DDSI-RTPS 9.6.1.1, participant 0
            except OSError:
                continue
            return domain
    raise OSError(f'no free DDS domain in {DOMAINS.start} to {DOMAINS.stop - 1}')


def tail_of(path: Path, lines: int) -> str:
    try:
        text = path.read_text(encoding='utf-8', errors='replace').strip()
    except OSError:
        return ''
    return '\n'.join(text.splitlines()[-lines:])
