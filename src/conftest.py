# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A simple robot for tests: limits, lag and delay, but no slip."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
import math
from pathlib import Path
from typing import Any

from husky_course.record import COLUMNS, Record
from husky_course.robot import RobotStart
from husky_driver.drive import Drive
from husky_driver.motion import Command, Odometry
from husky_runtime.domains import OwnDomain
import numpy as np
import pytest

PERIOD_SEC = 0.02


@pytest.fixture
def domain() -> Iterator[int]:
    """Give a test a DDS domain of its own."""
    with OwnDomain() as own:
        yield own.number


@dataclass
class Plant:
    """Unicycle behind the Husky's velocity and acceleration limits, with a lagging servo."""

    lag_sec: float = 0.05
    yaw_gain: float = 0.95
    delay_periods: int = 1
    now: Odometry = field(default_factory=lambda: Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))

    def __post_init__(self) -> None:
        self.commands = [Command(0.0, 0.0)]
        self._queue = deque([(0.0, 0.0)] * self.delay_periods)
        self._limited = (0.0, 0.0)

    def advance(self, command: Command) -> None:
        self.commands.append(command)
        self._queue.append(command)
        speed, yaw_rate = self._queue.popleft()
        last_speed, last_rate = self._limited
        speed = min(max(speed, -1.0, last_speed - 0.06), 1.0, last_speed + 0.06)
        yaw_rate = min(max(yaw_rate, -2.0, last_rate - 0.12), 2.0, last_rate + 0.12)
        self._limited = (speed, yaw_rate)
        time, x, y, yaw, v, w = self.now
        dt = PERIOD_SEC / 10
        for _ in range(10):
            v += (speed - v) * dt / self.lag_sec
            w += (self.yaw_gain * yaw_rate - w) * dt / self.lag_sec
            yaw += w * dt
            x, y = x + v * math.cos(yaw) * dt, y + v * math.sin(yaw) * dt
        self.now = Odometry(time + PERIOD_SEC, x, y, yaw, v, w)


@dataclass
class Run:
    """The course of a drive: every odometry, every command."""

    drive: Drive
    track: list[Odometry]
    commands: list[Command]


@pytest.fixture
def drive_to_end() -> Callable[..., Run]:
    def run(drive: Drive, plant: Plant | None = None, *, limit_sec: float = 300.0) -> Run:
        plant = plant or Plant()
        track, commands = [plant.now], list[Command]()
        while plant.now.time_sec < limit_sec:
            command = drive.step(plant.now)
            if command is None:
                return Run(drive, track, commands)
            commands.append(command)
            plant.advance(command)
            track.append(plant.now)
        raise AssertionError(f'still driving after {limit_sec} s, {drive.summary()}')

    return run


@pytest.fixture
def make_plant() -> type[Plant]:
    return Plant


@pytest.fixture
def courses() -> Path:
    """Return the folder of the courses that come with the lab."""
    return Path(__file__).resolve().parents[1] / 'config' / 'waypoints'


@pytest.fixture
def make_record() -> Callable[..., Record]:
    """Make the simulator's record of a run along given places, 20 ms apart."""

    def make(places: list[tuple[float, float]], **more: Any) -> Record:
        x, y = [place[0] for place in places], [place[1] for place in places]
        steps = list(zip(x, y, x[1:] + x[-1:], y[1:] + y[-1:], strict=True))
        speed = [math.hypot(b - a, d - c) / PERIOD_SEC for a, c, b, d in steps]
        table = {
            'time_sec': [i * PERIOD_SEC for i in range(len(x))],
            **{'x': x, 'y': y, 'odom_x': x, 'odom_y': y},
            'yaw': [math.atan2(d - c, b - a) if (a, c) != (b, d) else 0.0 for a, c, b, d in steps],
            'odom_yaw': [0.0] * len(x),
            'speed_m_s': speed,
            'yaw_rate_rad_s': [0.0] * len(x),
            'command_speed_m_s': [0.0, *speed[:-1]],
            'command_yaw_rate_rad_s': [0.0] * len(x),
        }
        table |= {column: values for column, values in more.items() if column in table}
        start_x, start_y, start_yaw = more.get('start', [0.0, 0.0, 0.0])
        return Record(
            file='test',
            world='test',
            robots=(RobotStart(x=start_x, y=start_y, yaw=start_yaw),),
            obstacles=(),
            rows=np.array([table[column] for column in COLUMNS]).T[:, None, :],
            collisions=tuple(more.get('collisions', ())),
            disturbances=tuple(more.get('disturbances', ())),
            overturns=tuple(more.get('overturns', ())),
            complete=more.get('complete', True),
        )

    return make
