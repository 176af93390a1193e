# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which of the two kinds of ROS the tests run on: few of them need to know."""

import os

SOURCED = os.environ.get('HUSKY_LAB_ROS') == 'sourced'
