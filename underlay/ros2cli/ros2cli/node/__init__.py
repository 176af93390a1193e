# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes that commands look at the graph by."""

# As rclpy.node.HIDDEN_NODE_PREFIX, which takes half a second to import.
NODE_NAME_PREFIX = '_ros2cli'
