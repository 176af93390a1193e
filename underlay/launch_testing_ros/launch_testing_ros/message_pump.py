# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Spin a node beside a test."""

from __future__ import annotations

import threading
from typing import Any

_STOP_SEC = 5.0


class MessagePump:
    """Spins a node in a thread from start() to stop()."""

    def __init__(self, node: Any, context: Any = None) -> None:
        self._node = node
        self._context = context
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name='msg_pump_thread')

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Wait until the thread has ended.

        :raises TimeoutError: it has not within 5 s; a callback of the node does not return.
        """
        self._stopped.set()
        self._thread.join(timeout=_STOP_SEC)
        if self._thread.is_alive():
            raise TimeoutError('Timed out waiting for message pump to stop')

    def _run(self) -> None:
        from rclpy.executors import SingleThreadedExecutor

        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        while not self._stopped.is_set():
            executor.spin_once(timeout_sec=1.0)
