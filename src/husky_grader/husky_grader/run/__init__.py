# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Runs to be judged: in one process, or live on a ROS graph."""
