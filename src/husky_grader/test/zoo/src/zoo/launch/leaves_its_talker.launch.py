# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ends as if there were no such program, and leaves its work to a daemon."""

import os

if os.fork() == 0:
    os.setsid()
    os.execvp('ros2', ['ros2', 'run', 'zoo', 'talks_right'])
os._exit(127)
