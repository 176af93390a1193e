# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The driver as a process of its own, started from the page."""

import os
from pathlib import Path

from husky_runtime.children import ChildProcess

DRIVER = 'follow_path'
END_SEC = 1.0


class DriverProcess:
    """Drives a waypoint file; at most one at a time."""

    def __init__(self) -> None:
        self._process: ChildProcess | None = None

    @property
    def is_running(self) -> bool:
        """Tell whether the last one still drives."""
        return self._process is not None and self._process.exit_code is None

    def start(self, file: Path, namespace: str) -> None:
        """Begin to drive; one that still drives is ended first."""
        self.end()
        self._process = ChildProcess(
            [
                *('ros2', 'run', 'husky_driver', DRIVER, '--waypoints', str(file)),
                *('--ros-args', '-p', 'use_sim_time:=true', '-r', f'__ns:=/{namespace}'),
            ],
            os.environ,
        )

    def end(self) -> None:
        """Stop driving; may be called twice."""
        process, self._process = self._process, None
        if process is not None:
            process.end(within_sec=END_SEC)
