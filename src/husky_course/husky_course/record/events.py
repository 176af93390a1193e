# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a collision is; `contacts` finds them."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Touch:
    """One collision: when and where it began, and how hard it was."""

    robot: str
    obstacle: str
    part: str
    time_sec: float
    force_n: float
    position: tuple[float, float, float]
