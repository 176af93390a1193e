# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The playpen in the browser, in a process of its own: live, as a replay, and to edit waypoints.

The simulator imports nothing of it.
"""
