# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Play a bag by a clock that can be paused, and message by message while it is."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Iterator, Mapping
import math
import time
from typing import Any

from ros2cli.node.direct import CommandNode
import rosbag2_py
from rosbag2_py._reader import on_split
from rosgraph_msgs.msg import Clock
from rtps_graph import names

from ros2bag import split_events

_SERVE_SEC = 0.01  # keys and services are served so often
_LAST_NS = 2**63 - 1  # no bag lasts longer


class PlaybackClock:
    """The time in a bag that is played; `steady` is the clock in seconds that drives it."""

    def __init__(
        self, rate: float, *, is_paused: bool, steady: Callable[[], float] = time.monotonic
    ) -> None:
        self._steady = steady
        self._rate = rate
        self._is_paused = is_paused
        self.jump(0)

    @property
    def now_ns(self) -> int:
        passed_sec = 0.0 if self._is_paused else self._steady() - self._since_sec
        return self._start_ns + int(passed_sec * self._rate * 1e9)

    def jump(self, now_ns: int) -> None:
        self._start_ns = now_ns
        self._since_sec = self._steady()

    @property
    def is_paused(self) -> bool:
        return self._is_paused

    @is_paused.setter
    def is_paused(self, value: bool) -> None:
        self.jump(self.now_ns)
        self._is_paused = value

    @property
    def rate(self) -> float:
        return self._rate

    @rate.setter
    def rate(self, value: float) -> None:
        self.jump(self.now_ns)
        self._rate = value

    def seconds_until(self, time_ns: int) -> float:
        if self._is_paused:
            return math.inf
        passed_sec = self._steady() - self._since_sec
        return (time_ns - self._start_ns) * 1e-9 / self._rate - passed_sec


class Playback:
    """Publishes what a bag holds when it is due; may be controlled from what `serve` calls.

    :param publishers: for each topic that is played; `publish` returns False where a message is
        for nobody.
    :param clock_publisher: of /clock; None where it is not asked for.
    """

    def __init__(
        self,
        node: CommandNode,
        args: argparse.Namespace,
        bag: rosbag2_py.BagMetadata,
        publishers: Mapping[str, Any],
        clock_publisher: Any,
    ) -> None:
        self._node = node
        self._args = args
        self._publishers = publishers
        self._clock_publisher = clock_publisher
        self._tell_split = split_events.of_player(node)
        self._clock_topics = _clock_topics(args, publishers)
        start_ns = bag.starting_time.nanoseconds + _nanoseconds(args.start_offset)
        self._first_ns = min(start_ns, _LAST_NS)
        self._end_ns = _end_ns(args, self._first_ns)
        self._clock = PlaybackClock(args.rate, is_paused=args.start_paused)
        self._messages: Iterator[tuple[str, bytes, int]] = iter(())
        self._next: tuple[str, bytes, int] | None = None
        self._is_playing = False
        self._is_stopped = False
        self._sought_ns: int | None = None
        self._serve_at_sec = -math.inf
        self._tick_at_sec = math.inf

    def play(self, serve: Callable[[], None], burst: int | None = None) -> bool:
        """Play the bag once; return at its end, but not while it is paused.

        :param serve: called every 10 ms.
        :param burst: how many messages are played at once at the beginning, 0 for all.
        :return: whether it may be played again: there was something to play, and nobody has
            stopped it.
        """
        self._go_to(self._first_ns)
        is_empty = self._next is None
        if self._sought_ns is not None:
            self._go_to(self._sought_ns)
            self._sought_ns = None
        self._is_playing = True
        self._tick_at_sec = time.monotonic() if self._args.clock else math.inf
        if burst is not None:
            self.burst(burst)
        while not self._is_stopped and (self._next is not None or self.is_paused):
            self._do_besides(serve)
            left_sec = self._clock.seconds_until(self._next[2]) if self._next else math.inf
            if left_sec <= 0.0:
                self._publish_next()
            else:
                self._sleep(left_sec)
        self._is_playing = False
        return not (is_empty or self._is_stopped)

    def wait(self, duration_sec: float, serve: Callable[[], None]) -> None:
        """Wait before the bag is played, with the same `serve`."""
        self._tick_at_sec = math.inf
        end_sec = time.monotonic() + duration_sec
        while not self._is_stopped and (left_sec := end_sec - time.monotonic()) > 0.0:
            self._do_besides(serve)
            self._sleep(left_sec)

    @property
    def is_paused(self) -> bool:
        return self._clock.is_paused

    def pause(self) -> None:
        self._clock.is_paused = True
        self._log.info('Paused')

    def resume(self) -> None:
        self._clock.is_paused = False
        self._log.info('Resumed')

    def toggle_paused(self) -> None:
        if self.is_paused:
            self.resume()
        else:
            self.pause()

    def play_next(self) -> bool:
        """Publish the next message now; False where there is none, or the bag is not paused."""
        if not self.is_paused:
            self._log.warning('The next message is played by itself, the bag is not paused')
            return False
        while self._next is not None:
            self._clock.jump(self._next[2])
            if self._publish_next():
                return True
        return False

    def burst(self, count: int) -> int:
        """
        Publish the next messages at once, 0 for all that are left, where the bag is paused.

        :return: how many there were.
        """
        if not self.is_paused:
            self._log.warning('Nothing is played at once, the bag is not paused')
            return 0
        played = 0
        while not (count and played == count) and self.play_next():
            played += 1
        self._log.info(f'Played {played} messages at once')
        return played

    def seek(self, time_ns: int) -> bool:
        """
        Go on at the first message of a time or after; before the bag is played, begin there.

        A time before the start is taken for the start. After the last message nothing is left.
        """
        time_ns = max(time_ns, self._first_ns)
        if self._is_playing:
            self._go_to(time_ns)
        else:
            self._sought_ns = time_ns
        return True

    def stop(self) -> None:
        """Play nothing more, also where the bag is paused or to be played again."""
        self._is_stopped = True
        self._log.info('Stopped')

    def play_again(self) -> bool:
        """Return False, as upstream's does until the bag has ended, and the command with it."""
        self._log.warning('The bag is not played again, it is being played')
        return False

    @property
    def rate(self) -> float:
        return self._clock.rate

    def set_rate(self, rate: float) -> bool:
        """Play so many times as fast as it was recorded; False where that is no rate."""
        if not 0.0 < rate < math.inf:
            self._log.warning(f'Rate {rate:g} is refused: it must be a number above 0')
            return False
        self._clock.rate = rate
        self._log.info(f'Rate {rate:g}')
        return True

    def change_rate(self, difference: float) -> None:
        # Ten steps down from 1 are 0, not what adding floats leaves.
        self.set_rate(round(self.rate + difference, 6))

    @property
    def _log(self) -> Any:
        return self._node.node.get_logger()

    def _go_to(self, time_ns: int) -> None:
        self._messages = _messages(
            self._args, list(self._publishers), time_ns, self._end_ns, self._tell_split
        )
        self._next = next(self._messages, None)
        self._clock.jump(time_ns)

    def _do_besides(self, serve: Callable[[], None]) -> None:
        """Do what is due besides messages."""
        now_sec = time.monotonic()
        if now_sec >= self._tick_at_sec:
            self._tick_at_sec = max(self._tick_at_sec + 1.0 / self._args.clock, now_sec)
            self._publish_clock(self._clock.now_ns)
        if now_sec >= self._serve_at_sec:
            self._serve_at_sec = now_sec + _SERVE_SEC
            serve()
            self._node.spin_once(0.0)

    def _sleep(self, left_sec: float) -> None:
        """Sleep until something is due: that is exact, waiting for ROS is not."""
        left_besides_sec = min(self._serve_at_sec, self._tick_at_sec) - time.monotonic()
        time.sleep(max(0.0, min(left_sec, left_besides_sec)))

    def _publish_next(self) -> bool:
        """Publish a message and read the next; False where it was for nobody."""
        assert self._next is not None
        topic, data, time_ns = self._next
        if topic in self._clock_topics:
            self._publish_clock(max(time_ns, self._clock.now_ns))
        was_sent = self._publishers[topic].publish(data) is not False
        self._next = next(self._messages, None)
        return was_sent

    def _publish_clock(self, now_ns: int) -> None:
        msg = Clock()
        msg.clock.sec, msg.clock.nanosec = divmod(now_ns, 10**9)
        self._clock_publisher.publish(msg)


def _clock_topics(args: argparse.Namespace, played: Collection[str]) -> set[str]:
    """Return the topics before whose messages the time is published."""
    wanted = {names.expand(topic) for topic in args.clock_topics}
    return {t for t in played if args.clock_topics_all or names.expand(t) in wanted}


def _messages(
    args: argparse.Namespace,
    topics: list[str],
    first_ns: int,
    end_ns: int | None,
    tell_split: split_events.Tell,
) -> Iterator[tuple[str, bytes, int]]:
    reader = rosbag2_py.SequentialReader()
    options = rosbag2_py.StorageOptions(str(args.bag_path), args.storage)
    reader.open(options, rosbag2_py.ConverterOptions())
    reader.set_filter(rosbag2_py.StorageFilter(topics=topics, services_events=topics))
    reader.seek(first_ns)
    on_split(reader, tell_split)  # not of the files that lie before
    while reader.has_next():
        message = reader.read_next()
        if end_ns is not None and message[2] > end_ns:
            return
        if message[2] >= first_ns:
            yield message


def _nanoseconds(seconds: float) -> int:
    return int(min(seconds * 1e9, _LAST_NS))


def _end_ns(args: argparse.Namespace, first_ns: int) -> int | None:
    """Return the time in the bag after which nothing is played; None for no such time."""
    ends = []
    if args.playback_duration > 0.0:
        ends.append(first_ns + _nanoseconds(args.playback_duration))
    elif args.playback_duration == 0.0:  # as upstream, not even what comes at the start
        ends.append(-1)
    if args.playback_until_sec >= 0.0:
        ends.append(_nanoseconds(args.playback_until_sec))
    if args.playback_until_nsec >= 0:
        ends.append(args.playback_until_nsec)
    return max(ends, default=None)
