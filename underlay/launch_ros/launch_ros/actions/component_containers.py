# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why there are no component containers."""

REFUSAL = (
    'component containers are C++ programs that this installation from the Python package index '
    'does not have: run the node as a Node with an executable of its package, or use a full ROS 2 '
    'Jazzy'
)
