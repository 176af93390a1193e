# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of this package; each loads what it needs when it can be interrupted."""

from collections.abc import Callable
import sys

from husky_runtime.start import run_moved, run_node


def main() -> int:
    """Run the simulator."""

    def load() -> Callable[[], int]:
        from husky_sim.ros.node import main

        return main

    return run_node(load)


def moved() -> None:
    """Run `view` or `replay`."""
    run_moved('husky_view')


if __name__ == '__main__':
    sys.exit(main())
