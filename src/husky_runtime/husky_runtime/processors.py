# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How many processors there are to work with."""

import os


def usable_processors() -> int:
    """Return how many this process may use; all of the machine where the system does not say."""
    if hasattr(os, 'sched_getaffinity'):  # not on macOS
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
