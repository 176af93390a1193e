# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A Husky in the graph of a student's program: the simulator, and the lab's own driver."""

from __future__ import annotations

from contextlib import ExitStack
import json
import os
from pathlib import Path

from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_runtime.children import ChildProcess, tail_of

from husky_grader.run.trusted import trusted

STARTED_SEC = 20.0  # wall time for simulator and driver, on a busy machine, to find each other


class Robot:
    """
    A Husky at the start of a course; a context manager that ends it.

    Simulator and driver are processes of their own, with this one's environment. What they print
    is in files of a folder.

    :param world: in which it drives, an MJCF file; empty: the playpen.
    """

    def __init__(self, course: Path, folder: Path, world: str = '') -> None:
        self._course = course
        self._folder = folder
        # JSON is YAML, as rcl reads it.
        self._in_world = ['--ros-args', '-p', f'world:={json.dumps(world)}'] if world else []
        self.limit_sec = STARTED_SEC + plan_route(load_course(course)).limit_sec

    def __enter__(self) -> Robot:
        with ExitStack() as stack:
            self._running = stack
            self._simulator = self._start('simulator.log', 'husky_sim.programs', *self._in_world)
            self._running = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._running.close()

    def drive(self) -> None:
        """Let the driver follow the course."""
        course = str(self._course.absolute())
        self._driver = self._start(
            'driver.log', 'husky_driver.follow_path', '--waypoints', course, *self._in_world
        )

    @property
    def stands(self) -> bool:
        """Whether it drives no more, for whatever reason."""
        return self._driver.exit_code is not None or self._simulator.exit_code is not None

    def why_not_there(self) -> str:
        """Return why it is not at the end of the course; nothing if it is."""
        if self._simulator.exit_code is not None:
            return tail_of(self._folder / 'simulator.log', 1) or 'the simulator has ended'
        if self._driver.exit_code == 0:
            return ''
        return tail_of(self._folder / 'driver.log', 1) or 'its driver says nothing'

    def _start(self, log: str, module: str, *words: str) -> ChildProcess:
        stream = self._running.enter_context((self._folder / log).open('w'))
        child = ChildProcess(trusted(module, *words), os.environ, stream)
        return self._running.enter_context(child)
