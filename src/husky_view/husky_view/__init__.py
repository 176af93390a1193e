# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The playpen in the browser: live, as a replay, and with an editor of waypoints."""
