# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The record of a run: its format, its writer and its reader."""

from husky_course.record.contents import (
    Collision,
    COLUMNS,
    Disturbance,
    MAX_RATE,
    Overturn,
    Row,
)
from husky_course.record.record import read_record, Record, RecordRefused
from husky_course.record.run import read_run, Run
from husky_course.record.writer import COURSE_NAME, FILE_NAME, RecordWriter

__all__ = [
    'COLUMNS',
    'COURSE_NAME',
    'FILE_NAME',
    'MAX_RATE',
    'Collision',
    'Disturbance',
    'Overturn',
    'Record',
    'RecordRefused',
    'RecordWriter',
    'Row',
    'Run',
    'read_record',
    'read_run',
]
