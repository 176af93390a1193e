# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Writes the record of a run while the run goes on: see `record`.

A block is written every BLOCK_PERIODS, so that memory stays the same however long the run is, and
a simulator that is killed loses only its last seconds.
"""

from array import array
from collections.abc import Callable, Iterable
from dataclasses import asdict
import errno
import io
import os
from pathlib import Path
from types import TracebackType
from typing import Any

from husky_course.outline import Outline
from husky_course.record import block_of, Collision, COLUMNS, FORMAT, VERSION
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.errors import SettingError
from husky_sim.recording.pushed import PushedBodies
from husky_sim.simulation import SimulatedRobot, Simulation

BLOCK_PERIODS = 100  # two seconds of simulated time


class RunRecorder:
    """Writes a run, one row every control period; the first is the start."""

    def __init__(
        self,
        simulation: Simulation,
        path: str | Path,
        *,
        complain: Callable[[str], object] | None = None,
    ) -> None:
        """
        Begin the file with the simulation as it is now; its folder is made where there is none.

        :param complain: called with one line when nothing more can be written (a full disk); the
            run continues without a record. None: OSError is raised.
        :raises OSError: if the file cannot be made.
        """
        self._simulation = simulation
        self._path = Path(path)
        self._complain = complain
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._file: io.FileIO | None = _new_file(self._path)
        self._pushed = PushedBodies(simulation)
        self._rows = array('d')
        self._events: list[dict[str, Any]] = []
        self.restart()

    def restart(self) -> None:
        """Drop everything and begin with the simulation as it is now."""
        if self._file is None:
            return
        self._file.seek(0)
        self._file.truncate()
        self._rows = array('d')
        self._events = []
        self._pushed.restart()
        self._write(_header(self._simulation))
        self.append()
        self._flush()

    def append(self) -> None:
        """Add the end of a control period."""
        time_sec = self._simulation.time_sec
        for robot in self._simulation.robots:
            self._rows.extend(_row(robot, time_sec))
        for name, qpos in self._pushed.moved():
            self._note('pushed', body=name, time_sec=time_sec, qpos=qpos)
        if self._simulation.touches:
            self._note_touches(self._simulation.touches)
            self._flush()
        elif len(self._rows) >= BLOCK_PERIODS * len(COLUMNS) * len(self._simulation.robots):
            self._flush()

    def disturb(self, time_sec: float, topic: str, nodes: Iterable[str]) -> None:
        """Record that nodes of other runs publish a topic."""
        self._note('disturbance', time_sec=time_sec, topic=topic, nodes=list(nodes))
        self._flush()

    def close(self) -> None:
        """Write the end of the run; may be called twice."""
        if self._file is not None:
            self._note_touches(self._simulation.unreported_touches())
            self._note('end', time_sec=self._simulation.time_sec)
            self._flush()
        self._release()

    def __enter__(self) -> 'RunRecorder':
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if error is None:
            self.close()
        else:
            self._release()  # a run that broke off has no end

    def _note(self, event: str, **values: Any) -> None:
        self._events.append({'event': event, **values})

    def _note_touches(self, touches: Iterable[Collision]) -> None:
        for touch in touches:
            self._note('collision', **asdict(touch))

    def _flush(self) -> None:
        rows, self._rows = self._rows, array('d')
        events, self._events = self._events, []
        if rows:
            shape = (-1, len(self._simulation.robots), len(COLUMNS))
            self._write(np.frombuffer(rows, dtype=np.float64).reshape(shape))
        if events:
            self._write(events)

    def _write(self, content: Any) -> None:
        if self._file is None:
            return
        left = memoryview(block_of(content))
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            self._release()
            if self._complain is None:
                raise OSError(error.errno, error.strerror, str(self._path)) from error
            self._complain(
                f'{self._path}: {error.strerror}; the record of the run ends here: free some '
                'space and drive again'
            )

    def _release(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None


def _new_file(path: Path) -> io.FileIO:
    """Make a new file, in place of one of that name; links and pipes are replaced, too."""
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.is_symlink() or not (path.is_char_device() or path.is_block_device()):
        path.unlink(missing_ok=True)
    return io.FileIO(path, 'xb')


def open_recorder(
    simulation: Simulation, path: str, complain: Callable[[str], object]
) -> RunRecorder | None:
    """
    Return the recorder that a simulator's parameter `record` asks for; empty: none.

    :raises SettingError: if the file cannot be made.
    """
    if not path:
        return None
    try:
        return RunRecorder(simulation, path, complain=complain)
    except OSError as error:
        raise SettingError(
            f'record={path!r}: cannot be written: {error.strerror}; name a file in a folder of '
            'your own'
        ) from error


def _header(simulation: Simulation) -> dict[str, Any]:
    return {
        'format': FORMAT,
        'version': VERSION,
        'world': simulation.config.world,
        'control_period_sec': CONTROL_PERIOD_SEC,
        'columns': COLUMNS,
        'robots': [
            {'name': start.name, 'start': [start.x, start.y, start.yaw]}
            for start in simulation.world.robots
        ],
        'obstacles': [_obstacle(outline) for outline in simulation.world.obstacles],
    }


def _obstacle(outline: Outline) -> dict[str, Any]:
    return {
        'name': outline.name,
        'x': outline.x,
        'y': outline.y,
        'yaw': outline.yaw,
        'size': outline.size,
    }


def _row(robot: SimulatedRobot, time_sec: float) -> Iterable[float]:
    state, filtered, controller = robot.state, robot.filtered, robot.controller
    return (
        time_sec,
        state.position[0],
        state.position[1],
        state.yaw,
        filtered.x,
        filtered.y,
        filtered.yaw,
        state.velocity[0],
        state.angular_velocity[2],
        controller.asked_speed_m_s,
        controller.asked_yaw_rate_rad_s,
    )
