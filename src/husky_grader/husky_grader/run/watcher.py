# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Watches the graph of a live run for why the controller cannot hear, or be heard."""

from rclpy.node import Node

from husky_grader.run.diagnosis import (
    Endpoint,
    Graph,
    reasons_of_graph,
    unheard_commands,
    unsent_commands,
)
from husky_grader.run.graph import read_graph


class GraphWatcher:
    """Keeps what the graph says of the controller, as the simulator's node sees it."""

    def __init__(self, node: Node, interface: str) -> None:
        self._node = node
        self._interface = interface
        self.unheard_looks = 0  # so many of the last ones have found commands that are not heard
        self._there: set[tuple[str, Endpoint]] = set()
        self.reasons: list[str] = []
        self.unsent: list[str] = []

    def look(self) -> None:
        """
        Look at the graph; what it said is kept, because nodes come and go.

        One that ends takes its endpoints from it one by one: what only lacks some of the last look
        says nothing, unless the next finds the same.
        """
        graph = read_graph(self._node, ours=(self._node.get_name(),))
        before, self._there = self._there, _program_in(graph)
        if graph.elsewhere is not None:
            self.unsent = list(unsent_commands(graph, self._interface))
        if not self._there or self._there < before:
            return
        self.reasons = reasons_of_graph(graph, self._interface)
        self.unsent = list(unsent_commands(graph, self._interface))
        unheard = any(unheard_commands(graph, self._interface))
        self.unheard_looks = self.unheard_looks + 1 if unheard else 0


def _program_in(graph: Graph) -> set[tuple[str, Endpoint]]:
    return {
        *(('publisher', each) for each in graph.publishers),
        *(('subscription', each) for each in graph.subscriptions),
    }
