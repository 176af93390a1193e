# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What tests do with processes and their output."""

from .output import basic_output_filter, expect_output, expected_output_from_file
from .process import launch_process, ProcessProxy

__all__ = [
    'ProcessProxy',
    'basic_output_filter',
    'expect_output',
    'expected_output_from_file',
    'launch_process',
]
