# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of this package; each loads what it needs when it can be interrupted."""

from collections.abc import Callable

from husky_runtime.start import INTERRUPTED, run


def check() -> int:
    """Check waypoint files."""

    def load() -> Callable[[], int]:
        from husky_grader.check import main

        return main

    return run(load, interrupted=INTERRUPTED, catches=True)


def drive() -> int:
    """Drive a path in the playpen, and report."""

    def load() -> Callable[[], int]:
        from husky_grader.drive_command import main

        return main

    return run(load, interrupted=INTERRUPTED, catches=True)


def grade() -> int:
    """Judge waypoint files, records and controllers."""

    def load() -> Callable[[], int]:
        from husky_grader.grade import main

        return main

    return run(load, interrupted=INTERRUPTED, catches=True)
