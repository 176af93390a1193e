# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The driver as a process of its own, started from the page."""

import contextlib
from functools import partial
import os
from pathlib import Path
import signal
import subprocess

from husky_runtime.parent_death import die_with_parent

DRIVER = 'follow_path'
END_SEC = 1.0


class DriverProcess:
    """Drives a waypoint file; at most one at a time."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def is_running(self) -> bool:
        """Tell whether the last one still drives."""
        return self._process is not None and self._process.poll() is None

    def start(self, file: Path, namespace: str) -> None:
        """Begin to drive; one that still drives is ended first."""
        self.end()
        self._process = subprocess.Popen(
            [
                *('ros2', 'run', 'husky_driver', DRIVER, '--waypoints', str(file)),
                *('--ros-args', '-p', 'use_sim_time:=true', '-r', f'__ns:=/{namespace}'),
            ],
            stdin=subprocess.DEVNULL,
            start_new_session=True,
            preexec_fn=partial(die_with_parent, signal.SIGTERM),
        )

    def end(self) -> None:
        """Stop driving; may be called twice."""
        process, self._process = self._process, None
        if process is None:
            return
        for number in (signal.SIGINT, signal.SIGKILL):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, number)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(END_SEC)
                return
