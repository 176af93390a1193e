# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node that upstream's verbs ask for: the daemon's, or one of their own where none runs."""

from __future__ import annotations

from typing import Any

from ros2cli.discovery import add_arguments
from ros2cli.node.daemon import DaemonNode, is_daemon_running, spawn_daemon
from ros2cli.node.direct import DirectNode

__all__ = ['DaemonNode', 'DirectNode', 'NodeStrategy', 'add_arguments']


class NodeStrategy:
    """Answers from the daemon; where none runs, from a node of its own, and starts the daemon.

    :param args: `no_daemon` keeps to the node; see `DirectNode` for the rest.
    """

    def __init__(self, args: Any) -> None:
        self._args = args
        self._direct_node: DirectNode | None = None
        self._daemon_node: DaemonNode | None = None
        wanted = not getattr(args, 'no_daemon', False)
        if wanted and is_daemon_running(args):
            candidate = DaemonNode(args)
            # It may have ended since.
            self._daemon_node = candidate if candidate.connected else None
        elif wanted:
            spawn_daemon(args)
        if self._daemon_node is None:
            self._direct_node = DirectNode(args)

    @property
    def daemon_node(self) -> DaemonNode | None:
        return self._daemon_node

    @property
    def direct_node(self) -> DirectNode:
        if self._direct_node is None:
            self._direct_node = DirectNode(self._args)
        return self._direct_node

    def __enter__(self) -> NodeStrategy:
        return self

    def __exit__(self, *error: Any) -> None:
        if self._direct_node is not None:
            self._direct_node.destroy()
        if self._daemon_node is not None:
            self._daemon_node.__exit__(*error)

    def __getattr__(self, name: str) -> Any:
        if self._daemon_node is not None and name in self._daemon_node.methods:
            return getattr(self._daemon_node, name)
        return getattr(self.direct_node, name)
