# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Why a synchronizer has not called back: it says nothing itself, upstream neither."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations
from time import monotonic
from typing import Any

from rclpy.logging import get_logger

SILENT_AFTER_SEC = 5.0
# Before as many messages of each filter nobody wonders.
ENOUGH_MESSAGES = 10
# Nanoseconds; simulations do not run for three years, and the wall's clock has done so since 1970.
_SIMULATED_BEFORE = 100_000_000 * 1_000_000_000


Rule = Callable[[], tuple[str, str]]


class Silence:
    """Looks, until the first callback, for what keeps it away, and says it once.

    :param fs: the filters; messages name the topics of those that have one.
    """

    def __init__(self, fs: Sequence[Any]) -> None:
        self._fs = fs
        self._names = [getattr(f, 'topic', f'filter {n}') for n, f in enumerate(fs, start=1)]
        self._counts = [0] * len(fs)
        self._began: float | None = None
        self._is_lack_said = False
        self._is_rule_said = False

    def explain(
        self, index: int, queues: Sequence[dict[int, Any]], queue_size: int, rule: Rule
    ) -> None:
        """Take note of a message that completes no set.

        :param rule: returns what the synchronizer does, after its name, and what to do about it.
        """
        self._counts[index] += 1
        enough = max(queue_size, ENOUGH_MESSAGES)
        if not self._is_rule_said and all(queues) and min(self._counts) > enough:
            self._is_rule_said = True
            warn_of(self._fs, self._why(queues, *rule()))
        elif not self._is_lack_said and not all(self._counts):
            now = monotonic()
            self._began = now if self._began is None else self._began
            if now - self._began >= SILENT_AFTER_SEC:
                self._is_lack_said = True
                self._warn_of_lack(now - self._began)

    def _warn_of_lack(self, waits_sec: float) -> None:
        counted = list(zip(self._names, self._counts, strict=True))
        missing = [name for name, count in counted if not count]
        others = [name for name, count in counted if count]
        warn_of(
            self._fs,
            f'no callback yet: no message on {" and ".join(missing)} in {waits_sec:.0f} s, while '
            f'{" and ".join(others)} had some; `ros2 doctor` looks for the cause',
        )

    def _why(self, queues: Sequence[dict[int, Any]], rule: str, advice: str) -> str:
        """Say which two filters are furthest apart, and by how much."""
        begins = f'no callback after {min(self._counts)} messages of each: '
        for name, queue in zip(self._names, queues, strict=True):
            if set(queue) == {0}:
                return f'{begins}the stamps of {name} are 0; its publisher must set header.stamp'
        pairs = combinations(zip(self._names, queues, strict=True), 2)
        gap, first, second = max(
            (min(abs(a - b) for a in one for b in other), name, other_name)
            for (name, one), (other_name, other) in pairs
        )
        apart = (
            f'{begins}the nearest stamps of {first} and {second} are {gap / 1e9:g} s apart, and '
            f'the synchronizer {rule}; '
        )
        newest = [max(queue) for queue in queues]
        if min(newest) < _SIMULATED_BEFORE < max(newest):
            return f'{apart}some are simulated time and some are not (use_sim_time)'
        return f'{apart}{advice}'


def warn_of(fs: Iterable[Any], text: str) -> None:
    """Log a warning, as the node of the filters where they have one."""
    nodes = (node for f in fs if (node := getattr(f, 'node', None)) is not None)
    node = next(nodes, None)
    (get_logger('message_filters') if node is None else node.get_logger()).warning(text)
