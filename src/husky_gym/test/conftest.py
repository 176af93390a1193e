# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Environments, and the lab's driver in them."""

from collections.abc import Callable, Iterator
import math
from pathlib import Path
from typing import Any

import gymnasium
from husky_driver.drive import Drive
from husky_driver.motion import Odometry, yaw_of
import numpy as np
import pytest

Env = gymnasium.Env[Any, Any]
Make = Callable[..., Env]


@pytest.fixture
def make() -> Iterator[Make]:
    """Make environments that end with the test."""
    made: list[Env] = []

    def new(**settings: Any) -> Env:
        made.append(gymnasium.make('husky_gym:HuskyPlaypen-v0', **settings))
        return made[-1]

    yield new
    for env in made:
        env.close()


@pytest.fixture
def courses() -> Path:
    return Path(__file__).resolve().parents[3] / 'config' / 'waypoints'


@pytest.fixture
def drive_episode() -> Callable[[Env], tuple[float, bool, bool, dict[str, Any]]]:
    """Drive an episode with the lab's driver; return the sum of rewards, and how it ended."""

    def run(env: Env) -> tuple[float, bool, bool, dict[str, Any]]:
        drive = Drive(env.unwrapped.planned)  # type: ignore[attr-defined]
        _, info = env.reset(seed=1)
        worth, ended, cut = 0.0, False, False
        while not ended and not cut:
            # To the last bit as a message has time and heading.
            seconds, nanoseconds = env.unwrapped.husky.simulation.stamp  # type: ignore[attr-defined]
            x, y, yaw, speed, yaw_rate = info['odometry']
            yaw = yaw_of(0.0, 0.0, math.sin(yaw / 2.0), math.cos(yaw / 2.0))
            time_sec = seconds + nanoseconds * 1e-9
            command = drive.step(Odometry(time_sec, x, y, yaw, speed, yaw_rate))
            speed, yaw_rate = command or (0.0, 0.0)
            _, reward, ended, cut, info = env.step(np.array([speed, yaw_rate / 2.0]))
            worth += float(reward)
        return worth, ended, cut, info

    return run
