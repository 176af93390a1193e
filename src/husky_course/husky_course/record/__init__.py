# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a run: its format, its writer and its reader."""

from husky_course.record.blocks import block_of, read_blocks
from husky_course.record.events import Collision, Disturbance, Push
from husky_course.record.record import (
    COLUMNS,
    FILE_NAME,
    FORMAT,
    read_record,
    Record,
    RecordRefused,
    VERSION,
)
from husky_course.record.run import read_run, RunRecord

__all__ = [
    'COLUMNS',
    'FILE_NAME',
    'FORMAT',
    'VERSION',
    'Collision',
    'Disturbance',
    'Push',
    'Record',
    'RecordRefused',
    'RunRecord',
    'block_of',
    'read_blocks',
    'read_record',
    'read_run',
]
