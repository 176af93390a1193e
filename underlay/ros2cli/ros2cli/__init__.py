# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The `ros2` command for an installation of ROS 2 Jazzy from Python wheels."""
