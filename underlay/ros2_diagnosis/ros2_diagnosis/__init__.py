# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Faults about which ROS itself is silent: what is wrong, why, and what mends it."""
