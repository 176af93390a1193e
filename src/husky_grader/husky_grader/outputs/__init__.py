# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What comes out of a graded class: pages, tables, and what an LMS takes back."""

from husky_grader.outputs.gradebook import Gradebook, read_gradebook
from husky_grader.outputs.outputs import (
    left_by_earlier,
    OUTPUT_FILES,
    Outputs,
    write_outputs,
)
from husky_grader.outputs.student_page import write_student_page

__all__ = [
    'OUTPUT_FILES',
    'Gradebook',
    'Outputs',
    'left_by_earlier',
    'read_gradebook',
    'write_outputs',
    'write_student_page',
]
