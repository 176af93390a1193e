# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Writing in a thread of its own.

Ctrl-C interrupts the main thread between any two steps: within a write it would leave half a
message in the file, and nothing behind that could be read. Tutorials end their programs so.
"""

from __future__ import annotations

from collections.abc import Callable
import os
from queue import SimpleQueue
import sys
import threading
from typing import Any

from rosbag2_py.bag_writer import BagWriter
from rosbag2_py.errors import BagError

_MOST_BYTES = 64 * 1024 * 1024
"""What may wait to be written, before who writes has to wait."""


class WritingThread:
    """Does what it is told, one after another, with a writer that nobody else uses then."""

    def __init__(self, writer: BagWriter) -> None:
        self._writer = writer
        # To put and to get are one step each, also where garbage is collected within one.
        self._tasks: SimpleQueue[tuple[int, Callable[..., None], tuple[Any, ...]]] = SimpleQueue()
        self._given = self._done = 0
        self._room = threading.Condition()
        self._failure: Exception | None = None
        self._process = os.getpid()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name='rosbag2_py', daemon=True)
        self._thread.start()

    def put(self, size: int, task: Callable[..., None], *arguments: Any) -> None:
        """
        Have something done later.

        :param size: how many bytes it keeps in memory until then.
        :raises BagError: what was put before could not be done, as where the disk is full.
        """
        self._check()
        self._tasks.put((size, task, arguments))
        self._given += size
        if self._given - self._done > _MOST_BYTES:
            with self._room:
                self._room.wait_for(lambda: self._given - self._done <= _MOST_BYTES)
            self._check()

    @property
    def has_ended(self) -> bool:
        """Whether all is done, and the writer closed."""
        return self._ended.is_set()

    def close(self) -> None:
        """
        Have all done, then close the writer; may be called twice.

        :raises BagError: as `put`.
        :raises KeyboardInterrupt: Ctrl-C came meanwhile; the bag is whole nevertheless.
        """
        self._tasks.put((0, self._writer.close, ()))
        if self._thread is threading.current_thread() or self._process != os.getpid():
            return  # A fork has no such thread, nor anything to write.
        interrupt = None
        # Not Thread.join(), which takes a thread for ended where it is interrupted (bpo-45274).
        while not self._ended.is_set():
            try:
                self._ended.wait()
            except KeyboardInterrupt as error:
                interrupt = error
        if interrupt:
            raise interrupt
        self._check()

    def close_at_exit(self) -> None:
        """Close without an exception, for nobody is left who could catch it."""
        try:
            self.close()
        except KeyboardInterrupt:
            pass  # The program ends already.
        except BagError as error:
            print(f'rosbag2_py: {error}', file=sys.stderr)

    def _check(self) -> None:
        if isinstance(self._failure, BagError):
            raise BagError(str(self._failure))
        if self._failure is not None:
            raise BagError(f"'{self._writer.folder}' cannot be written: {self._failure}")

    def _run(self) -> None:
        task: Callable[..., None] | None = None
        while task != self._writer.close:
            size, task, arguments = self._tasks.get()
            self._do(task, arguments)
            self._done += size
            with self._room:
                self._room.notify_all()
        self._ended.set()

    def _do(self, task: Callable[..., None], arguments: tuple[Any, ...]) -> None:
        try:
            task(*arguments)
            if self._tasks.empty():
                self._writer.flush()
        except Exception as error:
            self._failure = self._failure or error
