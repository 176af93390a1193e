# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the graph repeatedly while a page is open."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import threading

from ros2cli.discovery import read_graph
from ros2cli.errors import CommandError
from rtps_graph.graph import Graph

PERIOD_SEC = 1.0


class GraphFeed:
    """The newest graph; read in a thread of its own while there is a watcher."""

    def __init__(self, period_sec: float = PERIOD_SEC) -> None:
        self._period_sec = period_sec
        self._changed = threading.Condition()
        self._graph: Graph | None = None
        self._version = 0
        self._watchers = 0
        threading.Thread(target=self._read_repeatedly, daemon=True, name='graph feed').start()

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Keep the graph fresh inside the block."""
        with self._changed:
            self._watchers += 1
            self._changed.notify_all()
        try:
            yield
        finally:
            with self._changed:
                self._watchers -= 1

    def wait(self, seen: int, timeout_sec: float) -> tuple[int, Graph | None]:
        """Return the graph and its version, as soon as it is newer than the one seen."""
        with self._changed:
            self._changed.wait_for(lambda: self._version > seen, timeout_sec)
            return self._version, self._graph

    def _read_repeatedly(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._watchers > 0)
            try:
                graph = read_graph(quiet=True)
            except CommandError:
                continue  # what is wrong with the environment was said at the start
            with self._changed:
                if graph != self._graph:
                    self._graph = graph
                    self._version += 1
                    self._changed.notify_all()
                self._changed.wait_for(lambda: self._watchers == 0, self._period_sec)
