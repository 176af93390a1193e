# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of the nodes and topics of a ROS graph, in a file or live in the browser."""
