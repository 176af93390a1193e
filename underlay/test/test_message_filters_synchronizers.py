# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which messages belong together, in which order, from several threads, and why none do."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations
from threading import Barrier, Thread
from typing import Any

from geometry_msgs.msg import PointStamped
from hypothesis import given, strategies
from message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    silence,
    SimpleFilter,
    TimeSynchronizer,
)
import pytest
from rclpy.clock import ROSClock
from rclpy.time import Time
from std_msgs.msg import Header, String

MS = 1_000_000
shifts = strategies.lists(strategies.integers(0, 400), max_size=12, unique=True)


def at(milliseconds: float, frame: str = '') -> PointStamped:
    stamp = Time(nanoseconds=round(milliseconds * MS)).to_msg()
    return PointStamped(header=Header(stamp=stamp, frame_id=frame))


class Two:
    """Two filters, a synchronizer of them, and what comes out of it."""

    def __init__(self, kind: Callable[..., TimeSynchronizer], *arguments: Any) -> None:
        self.first, self.second = SimpleFilter(), SimpleFilter()
        self.sync = kind([self.first, self.second], *arguments)
        self.sets: list[tuple[Any, Any]] = []
        self.sync.registerCallback(lambda *messages: self.sets.append(messages))


def warnings_in(text: str) -> list[str]:
    """Return what was logged, without level, time and, of each line, the name of the logger."""
    return [line.split(']: ', 1)[1] for line in text.splitlines() if 'WARN' in line]


def test_equal_stamps_belong_together_in_any_order() -> None:
    for order in permutations(range(4)):
        two = Two(TimeSynchronizer, 4)
        firsts, seconds = ([at(t, name) for t in range(4)] for name in 'ab')
        for t in range(4):
            two.first.signalMessage(firsts[t])
        assert two.sets == []
        for t in order:
            two.second.signalMessage(seconds[t])
        newest = -1
        expected = []
        for t in order:  # what is older than the last set is gone
            if t > newest:
                expected.append((firsts[t], seconds[t]))
                newest = t
        assert two.sets == expected


def test_of_each_filter_the_newest_wait() -> None:
    two = Two(TimeSynchronizer, 2)
    for t in (3, 1, 2):
        two.first.signalMessage(at(t))
    for t in (1, 2, 3):
        two.second.signalMessage(at(t))
    assert [a.header.stamp.nanosec // MS for a, _ in two.sets] == [2, 3]


@given(shifts, shifts, strategies.randoms(use_true_random=False))
def test_close_stamps_belong_together_once(one: list[int], other: list[int], chance: Any) -> None:
    two = Two(ApproximateTimeSynchronizer, 20, 0.02)
    stamped = [(two.first, t) for t in one] + [(two.second, t) for t in other]
    chance.shuffle(stamped)
    waiting: list[list[int]] = [[], []]
    expected = []
    for source, t in stamped:
        source.signalMessage(at(t))
        mine, others = waiting if source is two.first else reversed(waiting)
        mine.append(t)
        near = [s for s in others if abs(s - t) < 20]
        if near:
            best = min(near, key=lambda s: abs(s - t))  # of equal ones that which came first
            mine.remove(t)
            others.remove(best)
            expected.append((t, best) if source is two.first else (best, t))
    assert [
        tuple(message.header.stamp.nanosec // MS for message in each) for each in two.sets
    ] == expected


def test_slop_itself_is_too_far_apart() -> None:
    two = Two(ApproximateTimeSynchronizer, 10, 0.05)
    two.first.signalMessage(at(100))
    two.second.signalMessage(at(150))
    assert two.sets == []
    two.second.signalMessage(at(149))
    assert len(two.sets) == 1


def test_all_of_a_set_lie_within_the_slop() -> None:
    filters, sets = [SimpleFilter() for _ in range(3)], list[Any]()
    sync = ApproximateTimeSynchronizer(iter(filters), queue_size=10, slop=0.05)
    sync.registerCallback(lambda *messages: sets.append([m.header.frame_id for m in messages]))
    for source, t, name in ((0, 60, 'a'), (2, 140, 'far'), (2, 90, 'c'), (1, 100, 'b')):
        filters[source].signalMessage(at(t, name))
    assert sets == [['a', 'b', 'c']]
    assert [len(queue) for queue in sync.queues] == [0, 0, 1]


def test_messages_without_stamp_have_their_time_of_arrival() -> None:
    two = Two(ApproximateTimeSynchronizer, 5, 10.0, True)
    stamped = PointStamped(header=Header(stamp=ROSClock().now().to_msg()))
    two.second.signalMessage(String(data='now'))
    two.first.signalMessage(stamped)
    assert two.sets == [(stamped, String(data='now'))]


def test_messages_without_stamp_are_left_out_and_that_is_said_once(
    capfd: pytest.CaptureFixture[str],
) -> None:
    two = Two(ApproximateTimeSynchronizer, 5, 10.0)
    cache = Cache(two.first)
    for _ in range(3):
        two.first.signalMessage(String())
    assert cache.cache_msgs == []
    assert two.sets == []
    err = capfd.readouterr().err
    assert '[message_filters_approx]' in err
    assert '[message_filters_cache]' in err
    assert warnings_in(err) == 2 * [
        'String has no header.stamp: such messages are left out; allow_headerless=True takes '
        'the time at which they arrive'
    ]
    with pytest.raises(AttributeError, match=r'String has no header\.stamp, which TimeSynchron'):
        Two(TimeSynchronizer, 5).first.signalMessage(String())


def test_a_callback_that_fails_stops_nothing() -> None:
    two = Two(TimeSynchronizer, 5)
    failing = two.sync.registerCallback(lambda *_: 1 / 0)
    two.first.signalMessage(at(1))
    with pytest.raises(ZeroDivisionError):
        two.second.signalMessage(at(1))
    two.sync.unregisterCallback(failing)
    for t in (1, 2):
        two.first.signalMessage(at(t))
        two.second.signalMessage(at(t))
    assert len(two.sets) == 3


def test_a_callback_may_add_a_message() -> None:
    two = Two(ApproximateTimeSynchronizer, 5, 0.01)
    two.sync.registerCallback(lambda first, _: two.first.signalMessage(first))
    two.first.signalMessage(at(1))
    two.second.signalMessage(at(1))
    assert [len(queue) for queue in two.sync.queues] == [1, 0]


def test_threads_lose_nothing() -> None:
    two = Two(TimeSynchronizer, 1000)
    start = Barrier(2)
    messages = [at(t) for t in range(300)]

    def feed(source: SimpleFilter) -> None:
        start.wait(10.0)
        for message in messages:
            source.signalMessage(message)

    threads = [Thread(target=feed, args=[source]) for source in (two.first, two.second)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20.0)
    assert [first for first, _ in two.sets] == messages


@pytest.mark.parametrize('kind', [TimeSynchronizer, ApproximateTimeSynchronizer])
def test_a_thread_waits_for_the_callback_of_another(kind: type[TimeSynchronizer]) -> None:
    two = Two(kind, 5, *([0.01] if kind is ApproximateTimeSynchronizer else []))
    waited: list[bool] = []

    def feed(milliseconds: int) -> None:
        for source in (two.first, two.second):
            source.signalMessage(at(milliseconds))

    other = Thread(target=feed, args=[99])

    def on_set(*_: Any) -> None:
        if not waited:
            other.start()
            other.join(0.2)  # in vain; without a lock it ends at once
            waited.append(other.is_alive())

    two.sync.registerCallback(on_set)
    feed(1)
    other.join(10.0)
    assert waited == [True]
    assert len(two.sets) == 2


@pytest.mark.parametrize(
    ('kind', 'arguments', 'firsts', 'seconds', 'expected'),
    [
        (
            TimeSynchronizer,
            [10],
            range(100, 2000, 100),
            range(103, 2000, 100),
            'the nearest stamps of filter 1 and filter 2 are 0.003 s apart, and the synchronizer '
            'calls back for equal ones; set the same stamp in both, or use '
            'ApproximateTimeSynchronizer(fs, queue_size, slop)',
        ),
        (
            ApproximateTimeSynchronizer,
            [5, 0.01],
            range(100, 2000, 100),
            range(120, 2000, 100),
            'the nearest stamps of filter 1 and filter 2 are 0.02 s apart, and the synchronizer '
            'calls back for less than slop=0.01; use a larger slop, or a larger queue_size where '
            'the messages of one come late',
        ),
        (
            ApproximateTimeSynchronizer,
            [10, 0.5],
            range(1_700_000_000_000, 1_700_000_019_000, 1000),
            range(1000, 20000, 1000),
            'the nearest stamps of filter 1 and filter 2 are 1.7e+09 s apart, and the '
            'synchronizer calls back for less than slop=0.5; some are simulated time and some '
            'are not (use_sim_time)',
        ),
        (
            TimeSynchronizer,
            [10],
            range(100, 2000, 100),
            19 * [0],
            'the stamps of filter 2 are 0; its publisher must set header.stamp',
        ),
    ],
)
def test_why_stamps_never_match_is_said_once(
    kind: Callable[..., TimeSynchronizer],
    arguments: list[Any],
    firsts: range,
    seconds: range,
    expected: str,
    capfd: pytest.CaptureFixture[str],
) -> None:
    two = Two(kind, *arguments)
    for count, (first, second) in enumerate(zip(firsts, seconds, strict=True)):
        assert capfd.readouterr().err == '', count  # ten of each are no reason to wonder
        two.first.signalMessage(at(first))
        two.second.signalMessage(at(second))
        if count == 10:
            said = warnings_in(capfd.readouterr().err)
            assert said == [f'no callback after 11 messages of each: {expected}']
    assert capfd.readouterr().err == ''
    assert two.sets == []


def test_that_one_filter_is_silent_is_said_once(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    seconds = iter([0.0, 4.9, 5.0])
    monkeypatch.setattr(silence, 'monotonic', lambda: next(seconds))
    two = Two(TimeSynchronizer, 10)
    for t in range(2):
        two.first.signalMessage(at(t))
    assert capfd.readouterr().err == ''
    two.first.signalMessage(at(2))
    assert warnings_in(capfd.readouterr().err) == [
        'no callback yet: no message on filter 2 in 5 s, while filter 1 had some; `ros2 doctor` '
        'looks for the cause'
    ]
    two.first.signalMessage(at(3))  # the clock is asked no more
    two.second.signalMessage(at(3))
    assert len(two.sets) == 1
    for t in range(100):
        two.first.signalMessage(at(t))
        two.second.signalMessage(at(t + 1000))
    assert capfd.readouterr().err == ''  # it has called back


def test_settings_with_which_nothing_is_called_back_are_named(
    capfd: pytest.CaptureFixture[str],
) -> None:
    two = Two(ApproximateTimeSynchronizer, 0, 0.0)
    for t in range(20):
        two.first.signalMessage(at(t))
        two.second.signalMessage(at(t))
    assert two.sets == []
    kept, close = warnings_in(capfd.readouterr().err)
    assert kept.startswith('queue_size=0: no message is kept')
    assert close.startswith('slop=0.0: the stamps of a set lie less than that apart')
    Two(ApproximateTimeSynchronizer, 1, 1e-9)
    assert capfd.readouterr().err == ''  # the least with which something may be
