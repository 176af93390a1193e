# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of this package; each loads what it needs when it can be interrupted."""

from collections.abc import Callable

from husky_runtime.start import run, run_node


def replay() -> int:
    """Replay a run."""

    def load() -> Callable[[], int]:
        from husky_view.replay.replay import main

        return main

    return run(load)


def view() -> int:
    """Show a running simulator."""

    def load() -> Callable[[], int]:
        from husky_view.live.node import main

        return main

    return run_node(load)
