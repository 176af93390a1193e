# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The score of a run, and why."""

from husky_grader.scoring.measurement import STANDING_M_S, STANDING_RAD_S
from husky_grader.scoring.report import (
    COLLISION_FACTOR,
    FULL_TRACKING_M,
    judge,
    MIN_TIME_FACTOR,
    NO_TRACKING_M,
    NOT_STOPPED_FACTOR,
    Report,
    TIME_ALLOWANCE,
)

__all__ = [
    'COLLISION_FACTOR',
    'FULL_TRACKING_M',
    'MIN_TIME_FACTOR',
    'NOT_STOPPED_FACTOR',
    'NO_TRACKING_M',
    'STANDING_M_S',
    'STANDING_RAD_S',
    'TIME_ALLOWANCE',
    'Report',
    'judge',
]
