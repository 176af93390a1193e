# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulates Clearpath Huskies with MuJoCo and speaks ROS 2."""
