# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of several filters in the order of their stamps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from threading import RLock
from typing import Any

from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time

from message_filters.simple_filter import Callback, connect, SimpleFilter

_NEVER = 2**63 - 1


@dataclass
class QueueStatus:
    """How one input is doing."""

    active: bool
    queue_size: int
    msgs_processed: int
    msgs_dropped: int


class _Input:
    """The messages of one filter that wait, and when the next is expected."""

    def __init__(self) -> None:
        self.events: list[tuple[int, int, Any]] = []
        self.period = Duration()
        self.active = False
        self.msgs_processed = 0
        self.msgs_dropped = 0
        self._next_stamp = _NEVER
        self._number = 0

    def push(self, stamp: int, msg: Any) -> None:
        heappush(self.events, (stamp, self._number, msg))  # equal stamps: as they came
        self._number += 1

    def pop(self) -> tuple[int, Any]:
        stamp, _, msg = heappop(self.events)
        self.msgs_processed += 1
        return stamp, msg

    def look(self) -> int:
        """Return the stamp of the next message: that which waits, or else that is expected."""
        if self.events:
            self.active = True
            stamp = self.events[0][0]
            self._next_stamp = stamp + self.period.nanoseconds
            return stamp
        return self._next_stamp if self.active else _NEVER


class InputAligner:
    """Hands on the messages of several filters in the order of their stamps, each to its own.

    A message waits for those of the other inputs that are expected before it, until one has been
    missing for `timeout`. It is no `SimpleFilter`: callbacks belong to an input.
    """

    def __init__(self, timeout: Duration, filters: Sequence[Any] | None = None) -> None:
        """Connect to filters.

        :param timeout: by how much newer stamps may be before an input is waited for no more.
        """
        self.timeout = timeout
        self.last_in_ts = _time(0)
        self.last_out_ts = _time(0)
        self.name = ''
        self.lock = RLock()
        self.event_queues: list[_Input] = []
        self.input_connections: list[tuple[Any, int]] = []
        self.signals: list[SimpleFilter] = []
        self.dispatch_timer: Any = None
        if filters is not None:
            self.connectInput(filters)

    def connectInput(self, filters: Sequence[Any]) -> None:
        """Take the messages of these filters, and forget all others and their callbacks."""
        with self.lock:
            self.disconnectAll()
            self.event_queues = [_Input() for _ in filters]
            self.signals = [SimpleFilter() for _ in filters]
            self.input_connections = [
                (source, connect(source, self.add, index)) for index, source in enumerate(filters)
            ]

    def disconnectAll(self) -> None:
        """Take no more messages of the filters."""
        with self.lock:
            for source, number in self.input_connections:
                source.unregisterCallback(number)
            self.input_connections = []

    def registerCallback(self, index: int, callback: Callback, *args: Any) -> int:
        """Call `callback` with each message of the filter `index`, followed by `args`."""
        self._input(index)
        return self.signals[index].registerCallback(callback, *args)

    def setName(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        return self.name

    def setInputPeriod(self, index: int, period: Duration) -> None:
        """Say how far apart the messages of an input are."""
        self._input(index).period = period

    def getQueueStatus(self, index: int) -> QueueStatus:
        """Return how an input is doing."""
        queue = self._input(index)
        return QueueStatus(
            queue.active, len(queue.events), queue.msgs_processed, queue.msgs_dropped
        )

    def setupDispatchTimer(self, node: Node, update_rate: Duration) -> None:
        """Dispatch by a timer.

        :param update_rate: its period, in spite of its name.
        """
        period_sec = update_rate.nanoseconds / 1e9
        self.dispatch_timer = node.create_timer(period_sec, self.dispatchMessages)

    def add(self, msg: Any, queue_index: int) -> None:
        """Let a message wait; one that is older than what was handed on is dropped."""
        time = Time.from_msg(msg.header.stamp)
        with self.lock:
            queue = self._input(queue_index)
            if time < self.last_out_ts:
                queue.msgs_dropped += 1
                return
            self.last_in_ts = max(self.last_in_ts, time)
            queue.push(time.nanoseconds, msg)

    def dispatchMessages(self) -> None:
        """Hand on all messages before which no other is expected."""
        with self.lock:
            if any(queue.events for queue in self.event_queues):
                while self._dispatch():
                    pass

    def _dispatch(self) -> bool:
        """Hand on a message, or give up an input; False: there is neither to do."""
        stamps = [queue.look() for queue in self.event_queues]
        index = stamps.index(min(stamps))
        queue = self.event_queues[index]
        if queue.events:
            stamp, msg = queue.pop()
            self.last_out_ts = _time(stamp)
            self.signals[index].signalMessage(msg)
            return True
        if self.last_in_ts.nanoseconds - stamps[index] >= self.timeout.nanoseconds:
            queue.active = False
            return True
        return False

    def _input(self, index: int) -> _Input:
        try:
            return self.event_queues[index]
        except IndexError:
            count = len(self.event_queues)
            raise IndexError(
                f'index={index}: there are {count} inputs, the first is 0; connectInput(filters) '
                'comes first'
            ) from None


def _time(nanoseconds: int) -> Time:
    return Time(nanoseconds=nanoseconds, clock_type=ClockType.ROS_TIME)
