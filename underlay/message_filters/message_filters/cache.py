# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The newest messages, to be looked up by time."""

from __future__ import annotations

from threading import Lock
from typing import Any

from rclpy.time import Time

from message_filters.simple_filter import connect, SimpleFilter
from message_filters.stamps import Stamps


class Cache(SimpleFilter):
    """Keeps the newest messages of a filter, and lets each of them out.

    They are kept in the order in which they arrived. Stamps of messages are in ROS time, as is
    `node.get_clock().now()`; `Time()` alone is in another, which rclpy does not compare.
    """

    def __init__(self, f: Any, cache_size: int = 1, allow_headerless: bool = False) -> None:
        """Connect to a filter.

        :param cache_size: how many messages to keep.
        :param allow_headerless: keep messages without stamp too, by the time of their arrival.
        """
        super().__init__()
        self.cache_size = cache_size
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.allow_headerless = allow_headerless
        self._stamps = Stamps('message_filters_cache')
        self._lock = Lock()  # both lists change together
        self.connectInput(f)

    def connectInput(self, f: Any) -> None:
        """Keep the messages of one more filter."""
        self.incoming_connection = connect(f, self.add)

    def add(self, msg: Any) -> None:
        """Keep a message, and let it out."""
        stamp = self._stamps.of(msg, self.allow_headerless)
        if stamp is None:
            return
        with self._lock:
            self.cache_times.append(stamp)
            self.cache_msgs.append(msg)
            if len(self.cache_msgs) > self.cache_size:
                del self.cache_msgs[0], self.cache_times[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """Return the messages from one time to another, both included.

        :raises AssertionError: the interval ends before it begins.
        :raises TypeError: a time is no `rclpy.time.Time`, or of another clock.
        """
        kept = self._kept(from_stamp, to_stamp)
        if from_stamp > to_stamp:
            raise AssertionError(
                f'from_stamp={from_stamp} is after to_stamp={to_stamp}; the earlier comes first'
            )
        return [msg for msg, time in kept if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """Return the first message of this time or later; None where there is none.

        :raises TypeError: as in `getInterval`.
        """
        return next((msg for msg, time in self._kept(stamp) if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """Return the last message of this time or earlier; None where there is none.

        :raises TypeError: as in `getInterval`.
        """
        kept = reversed(self._kept(stamp))
        return next((msg for msg, time in kept if time <= stamp), None)

    def getLastestTime(self) -> Time | None:
        """Return the stamp of the newest message; the name is Jazzy's."""
        kept = self._kept()
        return kept[-1][1] if kept else None

    def getOldestTime(self) -> Time | None:
        """Return the stamp of the oldest message."""
        kept = self._kept()
        return kept[0][1] if kept else None

    def getLast(self) -> Any:
        """Return the first message that is not older than the newest; None where there is none."""
        stamp = self.getLastestTime()
        return None if stamp is None else self.getElemAfterTime(stamp)

    def _kept(self, *stamps: Time) -> list[tuple[Any, Time]]:
        """Return messages and their times, to which the given ones can be compared."""
        with self._lock:
            kept = list(zip(self.cache_msgs, self.cache_times, strict=True))
        for stamp in stamps:
            if not isinstance(stamp, Time):
                raise TypeError(
                    f'{stamp!r} is no rclpy.time.Time; of a message that is '
                    'Time.from_msg(msg.header.stamp)'
                )
            for _, time in kept:
                if time.clock_type != stamp.clock_type:
                    raise TypeError(
                        f"Can't compare times with different clock types: {stamp} with those of "
                        f'messages; use clock_type=ClockType.{time.clock_type.name}'
                    )
        return kept
