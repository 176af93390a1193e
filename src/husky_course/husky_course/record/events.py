# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What can happen in a run between two rows of its record."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Collision:
    """One collision: when and where it began, and how hard it was."""

    robot: str
    obstacle: str
    part: str
    time_sec: float
    force_n: float
    position: tuple[float, float, float]

    def __str__(self) -> str:
        return f'{self.obstacle} ({self.part}, {self.force_n:.0f} N) at {self.time_sec:.1f} s'


@dataclass(frozen=True, kw_only=True)
class Disturbance:
    """Somebody else spoke on a topic of this run: when it was noticed, where, and who."""

    time_sec: float
    topic: str
    nodes: tuple[str, ...]


@dataclass(frozen=True, kw_only=True, eq=False)
class Push:
    """Where a body went that was pushed."""

    time_sec: Array
    qpos: Array  # (n, joint coordinates of the body)
