# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The transforms of a robot's links, from its URDF and the positions of its joints."""
