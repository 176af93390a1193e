# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a run: everything a report needs, in one JSON file."""

from array import array
from collections.abc import Iterable
import json
from pathlib import Path
from typing import Any

import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.contacts import Touch
from husky_sim.outline import clearances, Outline
from husky_sim.pushed import PushedBodies
from husky_sim.simulation import SimulatedRobot, Simulation

FORMAT = 'husky_playpen_record'
VERSION = 1
COLUMNS = (
    'time_sec',
    'x',
    'y',
    'yaw',
    'odom_x',
    'odom_y',
    'odom_yaw',
    'speed_m_s',
    'yaw_rate_rad_s',
    'command_speed_m_s',
    'command_yaw_rate_rad_s',
)


class RunRecord:
    """Collects a run, one entry every control period; the first is the start."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._pushed = PushedBodies(simulation)
        self.restart()

    def restart(self) -> None:
        """Drop everything and begin with the simulation as it is now."""
        self._entries = {robot.name: array('d') for robot in self._simulation.robots}
        self._touches: list[Touch] = []
        self._pushed.restart()
        self.append()

    def append(self) -> None:
        """Add the end of a control period."""
        time_sec = self._simulation.time_sec
        for robot in self._simulation.robots:
            self._entries[robot.name].extend(_entry(robot, time_sec))
        self._touches.extend(self._simulation.touches)
        self._pushed.look()

    def as_dict(self) -> dict[str, Any]:
        """Return the record as it is written."""
        simulation = self._simulation
        obstacles = simulation.world.obstacles
        tables = {
            name: np.frombuffer(entries, dtype=np.float64).reshape(-1, len(COLUMNS))
            for name, entries in self._entries.items()
        }
        return {
            'format': FORMAT,
            'version': VERSION,
            'world': simulation.config.world,
            'control_period_sec': CONTROL_PERIOD_SEC,
            'start': {
                start.name: [start.x, start.y, start.yaw] for start in simulation.world.robots
            },
            'robots': {
                name: dict(zip(COLUMNS, table.T.tolist(), strict=True))
                for name, table in tables.items()
            },
            'collisions': _collisions([*self._touches, *simulation.unreported_touches()]),
            'pushed': self._pushed.as_dict(),
            'obstacles': [_obstacle(outline) for outline in obstacles],
            'min_clearance_m': {
                name: _nearest(table, obstacles) for name, table in tables.items()
            },
        }

    def write(self, path: str) -> None:
        """Write the file, whole or not at all."""
        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(f'.{target.name}.part')
        part.write_text(json.dumps(self.as_dict()) + '\n', encoding='utf-8')
        part.replace(target)


def _entry(robot: SimulatedRobot, time_sec: float) -> Iterable[float]:
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


def _collisions(touches: list[Touch]) -> list[dict[str, Any]]:
    return [
        {
            'robot': touch.robot,
            'obstacle': touch.obstacle,
            'part': touch.part,
            'time_sec': touch.time_sec,
            'force_n': touch.force_n,
            'position': list(touch.position),
        }
        for touch in sorted(touches, key=lambda touch: touch.time_sec)
    ]


def _obstacle(outline: Outline) -> dict[str, Any]:
    return {
        'name': outline.name,
        'type': outline.type,
        'x': outline.x,
        'y': outline.y,
        'yaw': outline.yaw,
        'size': list(outline.size),
    }


def _nearest(table: np.ndarray, obstacles: tuple[Outline, ...]) -> float | None:
    if not obstacles:
        return None
    return float(clearances(table[:, 1:4], obstacles).min())
