# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions of launch descriptions under test."""

from launch_testing.actions import ReadyToTest

__all__ = ['ReadyToTest']
