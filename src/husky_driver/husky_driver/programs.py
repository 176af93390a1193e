# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of this package; each loads what it needs when it can be interrupted."""

from collections.abc import Callable

from husky_runtime.start import INTERRUPTED, run_moved, run_node


def follow_path() -> int:
    """Drive along a waypoint file."""

    def load() -> Callable[[], int]:
        from husky_driver.follow_path import main

        return main

    return run_node(load, interrupted=INTERRUPTED, catches=True)


def teleop() -> int:
    """Drive by the keys."""

    def load() -> Callable[[], int]:
        from husky_driver.teleop import main

        return main

    return run_node(load, interrupted=INTERRUPTED, catches=True)


def moved() -> None:
    """Run `check`, `drive` or `grade`."""
    run_moved('husky_grader')
