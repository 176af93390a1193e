# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Waypoint files, routes, obstacles seen from above, and the record of a run."""
