# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Writes a record while the run goes on.

A record is one file of blocks: a header (JSON: world, robots, obstacles, ...), then tables of one
row a control period, and between them lists of events (JSON: collisions, robots that turn over,
pushed bodies, disturbances, the end). A block is written every BLOCK_PERIODS, so that memory stays
the same however long the run is, and a simulator that is killed leaves all but its last moments.
"""

from array import array
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
import errno
import io
from operator import attrgetter
import os
from pathlib import Path
from typing import Any

import numpy as np

from husky_course.outline import Outline
from husky_course.record.blocks import block_of
from husky_course.record.contents import Collision, COLUMNS, Disturbance, Overturn, Row
from husky_course.robot import RobotStart

FORMAT = 'husky_playpen_record'
VERSION = 3
FILE_NAME = 'run.record'
COURSE_NAME = 'run.waypoints.yaml'
"""The course of the run beside it, named as no file of a person is."""
BLOCK_PERIODS = 100  # two seconds of simulated time

_values = attrgetter(*COLUMNS)


class RecordWriter:
    """Writes rows and events into a new file."""

    def __init__(
        self,
        path: str | Path,
        *,
        world: str,
        conditions: Sequence[str],
        control_period_sec: float,
        robots: Sequence[RobotStart],
        obstacles: Sequence[Outline],
        on_full: Callable[[str], object] | None = None,
    ) -> None:
        """
        Make the file, and its folder where there is none.

        :param conditions: the settings that are not the default, as NAME:=VALUE.
        :param on_full: called with one line when nothing more can be written (a full disk), and
            the run goes on without; None: OSError is raised.
        :raises OSError: if the file cannot be made.
        """
        self._path = Path(path)
        self._on_full = on_full
        self._header = {
            'format': FORMAT,
            'version': VERSION,
            'world': world,
            'conditions': tuple(conditions),
            'control_period_sec': control_period_sec,
            'columns': COLUMNS,
            'robots': [
                {'name': robot.name, 'start': [robot.x, robot.y, robot.yaw]} for robot in robots
            ],
            'obstacles': [asdict(outline) for outline in obstacles],
        }
        self._robots = len(robots)
        self._rows = array('d')
        self._events: list[dict[str, Any]] = []
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._file: io.FileIO | None = _new_file(self._path)
        self.restart()

    def restart(self) -> None:
        """Drop everything that was written and begin anew."""
        self._rows = array('d')
        self._events = []
        if self._file is not None:
            self._file.seek(0)
            self._file.truncate()
            self._write(self._header)

    def append(self, rows: Iterable[Row]) -> None:
        """Add the end of a control period, one row a robot."""
        for row in rows:
            self._rows.extend(_values(row))
        if len(self._rows) >= BLOCK_PERIODS * len(COLUMNS) * self._robots:
            self.flush()

    def add_collision(self, collision: Collision) -> None:
        self._add('collision', **asdict(collision))

    def add_push(self, *, body: str, time_sec: float, qpos: Sequence[float]) -> None:
        self._add('pushed', body=body, time_sec=time_sec, qpos=qpos)

    def add_overturn(self, overturn: Overturn) -> None:
        self._add('overturn', **asdict(overturn))

    def add_disturbance(self, disturbance: Disturbance) -> None:
        self._add('disturbance', **asdict(disturbance))

    def end(self, time_sec: float) -> None:
        """Note that the run is whole, and close the file."""
        self._add('end', time_sec=time_sec)
        self.flush()
        self.close()

    def flush(self) -> None:
        """Write what was added."""
        rows, self._rows = self._rows, array('d')
        events, self._events = self._events, []
        if rows:
            shape = (-1, self._robots, len(COLUMNS))
            self._write(np.frombuffer(rows, dtype=np.float64).reshape(shape))
        if events:
            self._write(events)

    def close(self) -> None:
        """Close the file without an end, unless it has one; may be called twice."""
        if self._file is not None:
            self._file.close()
            self._file = None

    @property
    def closed(self) -> bool:
        return self._file is None

    def _add(self, event: str, **values: Any) -> None:
        self._events.append({'event': event, **values})

    def _write(self, content: Any) -> None:
        if self._file is None:
            return
        left = memoryview(block_of(content))
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            self.close()
            if self._on_full is None:
                raise OSError(error.errno, error.strerror, str(self._path)) from error
            self._on_full(
                f'{self._path}: {error.strerror}; the record of the run ends here: free some '
                'space and drive again'
            )


def _new_file(path: Path) -> io.FileIO:
    """Make a file in the place of what has its name: no link is followed, no pipe waited for."""
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.is_symlink() or not (path.is_char_device() or path.is_block_device()):
        path.unlink(missing_ok=True)
    return io.FileIO(path, 'xb')
