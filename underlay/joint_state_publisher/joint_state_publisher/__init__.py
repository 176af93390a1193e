# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Positions for the joints of a robot, for those that nothing measures."""
