# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Wait for several things before something is called."""

from __future__ import annotations

from collections.abc import Callable
import threading


class ReadyAggregator:
    """Calls a function when its own ready_fn is called for the nth time, and only then."""

    def __init__(self, ready_fn: Callable[[], object], num_to_aggregate: int) -> None:
        self._ready_fn = ready_fn
        self._left = num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        """Count this call; from any thread."""
        with self._lock:
            self._left -= 1
            is_last = self._left == 0
        # Outside of the lock, for it may come back here.
        if is_last:
            self._ready_fn()
