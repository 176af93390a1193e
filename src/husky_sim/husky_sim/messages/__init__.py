# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages in serialized form, of which only the numbers change."""
