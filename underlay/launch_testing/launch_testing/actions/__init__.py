# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Actions of test descriptions."""

from .gtest import GTest
from .pytest import PyTest
from .ready import ReadyToTest

__all__ = ['GTest', 'PyTest', 'ReadyToTest']
