# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Callbacks with one message of each of several filters, which belong together by their stamps."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from threading import RLock
from typing import Any

from rclpy.duration import Duration
from rclpy.time import Time

from message_filters.silence import Silence, warn_of
from message_filters.simple_filter import connect, SimpleFilter
from message_filters.stamps import Stamps

Queue = dict[int, Any]


class TimeSynchronizer(SimpleFilter):
    """Lets out a message of each filter, together, as soon as it has one of each with one stamp.

    Callbacks are called one after another, in the thread that brings the last message.
    """

    def __init__(self, fs: Iterable[Any], queue_size: int) -> None:
        """Connect to filters.

        :param queue_size: how many messages of each filter wait for the others.
        """
        super().__init__()
        self.queue_size = queue_size
        # Upstream's is not reentrant: a callback that adds a message waits for ever there.
        self.lock = RLock()
        self.connectInput(fs)
        if not queue_size >= 1:
            warn_of(
                self._fs,
                f'queue_size={queue_size!r}: no message is kept, so that there is never a '
                'callback; use 1 or more',
            )

    def connectInput(self, fs: Iterable[Any]) -> None:
        """Take the messages of these filters, and of no others."""
        self._fs = list(fs)
        self.queues: list[Queue] = [{} for _ in self._fs]
        self._silence: Silence | None = Silence(self._fs)
        self.input_connections = [
            connect(f, self.add, queue, index)
            for index, (f, queue) in enumerate(zip(self._fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Keep a message in its queue, and let out the set that it completes.

        :raises AttributeError: the message has no stamp.
        """
        if not hasattr(getattr(msg, 'header', None), 'stamp'):
            raise AttributeError(
                f'{type(msg).__name__} has no header.stamp, which TimeSynchronizer compares; '
                'ApproximateTimeSynchronizer(fs, queue_size, slop, allow_headerless=True) '
                'takes the time of arrival'
            )
        stamp = Time.from_msg(msg.header.stamp).nanoseconds
        with self.lock:
            self._keep(msg, stamp, my_queue)
            common = set(self.queues[0]).intersection(*self.queues[1:])
            if common:
                self._let_out([min(common)] * len(self.queues), before=min(common))
            else:
                self._explain(my_queue_index)

    def _keep(self, msg: Any, stamp: int, queue: Queue) -> None:
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]

    def _let_out(self, stamps: list[int], before: int = 0) -> None:
        """Take a set out of the queues, and what is older than `before`; then call back."""
        self._silence = None
        messages = [queue.pop(stamp) for queue, stamp in zip(self.queues, stamps, strict=True)]
        for queue in self.queues:
            for stamp in [old for old in queue if old < before]:
                del queue[stamp]
        self.signalMessage(*messages)

    def _explain(self, index: int | None) -> None:
        if self._silence is not None and index is not None:
            self._silence.explain(index, self.queues, self.queue_size, self._rule)

    def _rule(self) -> tuple[str, str]:
        """Return when it calls back, and what to do where that is never."""
        return (
            'calls back for equal ones',
            'set the same stamp in both, or use ApproximateTimeSynchronizer(fs, queue_size, slop)',
        )


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Lets out a message of each filter, together, as soon as their stamps are close enough."""

    def __init__(
        self,
        fs: Iterable[Any],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
    ) -> None:
        """Connect to filters.

        :param queue_size: how many messages of each filter wait for the others.
        :param slop: in seconds; the stamps of a set lie less than that apart.
        :param allow_headerless: take the time of arrival of messages without stamp.
        """
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless
        self._stamps = Stamps('message_filters_approx')
        super().__init__(fs, queue_size)
        if not slop > 0:
            warn_of(
                self._fs,
                f'slop={slop!r}: the stamps of a set lie less than that apart, so that there is '
                'never a callback; use seconds above 0, or TimeSynchronizer for equal stamps',
            )

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Keep a message in its queue, and let out the set that it completes."""
        time = self._stamps.of(msg, self.allow_headerless)
        if time is None:
            return
        stamp = time.nanoseconds
        with self.lock:
            self._keep(msg, stamp, my_queue)
            stamps = self._nearest(stamp, my_queue_index)
            if stamps is not None:
                self._let_out(stamps)
            else:
                self._explain(my_queue_index)

    def _nearest(self, stamp: int, index: int | None) -> list[int] | None:
        """Return the stamps of a set that the new message completes, the nearest to it first."""
        slop = self.slop.nanoseconds
        near = []
        for number, queue in enumerate(self.queues):
            if number == index:
                near.append([stamp])
                continue
            within = [other for other in queue if abs(other - stamp) <= slop]
            near.append(sorted(within, key=lambda other: abs(other - stamp)))
        for stamps in product(*near):
            fits = max(stamps) - min(stamps) < slop
            if fits and all(s in queue for s, queue in zip(stamps, self.queues, strict=True)):
                return list(stamps)
        return None

    def _rule(self) -> tuple[str, str]:
        return (
            f'calls back for less than slop={self.slop.nanoseconds / 1e9:g}',
            'use a larger slop, or a larger queue_size where the messages of one come late',
        )
