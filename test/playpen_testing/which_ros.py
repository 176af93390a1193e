# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which of the two kinds of ROS the tests run on, and what a small one lacks: few need to know."""

import os

from ament_index_python.packages import get_packages_with_prefixes

SOURCED = os.environ.get('HUSKY_LAB_ROS') == 'sourced'


def lacks(package: str) -> bool:
    """Return whether a package is not installed with the ROS that is sourced."""
    return SOURCED and package not in get_packages_with_prefixes()
