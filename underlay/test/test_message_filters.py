# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Filters without topics: the interface, what they let out and keep, what they refuse."""

from __future__ import annotations

from collections.abc import Callable
import inspect
from typing import Any

from builtin_interfaces.msg import Time as TimeMsg
from geometry_msgs.msg import PointStamped
import message_filters
from message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    Chain,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)
from message_filters.delta_filter import (
    CachedComparisonHandler,
    ComparisonFilter,
    ComparisonHandler,
    DeltaCompare,
    DeltaFilter,
    PathDeltaFilter,
)
from message_filters.input_aligner import InputAligner, QueueStatus
import pytest
from rclpy.clock import ClockType, ROSClock
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from rclpy.time import Time
from std_msgs.msg import Header, String

MS = 1_000_000


def at(milliseconds: float, frame: str = '') -> PointStamped:
    stamp = Time(nanoseconds=round(milliseconds * MS)).to_msg()
    return PointStamped(header=Header(stamp=stamp, frame_id=frame))


def when(milliseconds: float) -> Time:
    return Time(nanoseconds=round(milliseconds * MS), clock_type=ClockType.ROS_TIME)


def test_the_interface_is_that_of_jazzy() -> None:
    known: dict[Callable[..., Any], str] = {
        Subscriber: '(node, msg_type, topic, qos_profile=10, **kwargs)',
        Cache: '(f, cache_size=1, allow_headerless=False)',
        Chain: '(message_filter=None)',
        TimeSynchronizer: '(fs, queue_size)',
        ApproximateTimeSynchronizer: '(fs, queue_size, slop, allow_headerless=False)',
        InputAligner: '(timeout, filters=None)',
        DeltaFilter: '(field_getters, message_filter=None)',
        PathDeltaFilter: '(field_path_list, message_filter=None)',
        ComparisonFilter: '(comparison_handler, message_filter=None)',
        DeltaCompare: '(field_getters)',
        SimpleFilter.registerCallback: '(self, callback, *args)',
        SimpleFilter.signalMessage: '(self, *msg)',
        SimpleFilter.unregisterCallback: '(self, conn)',
        TimeSynchronizer.add: '(self, msg, my_queue, my_queue_index=None)',
        Cache.getInterval: '(self, from_stamp, to_stamp)',
        InputAligner.registerCallback: '(self, index, callback, *args)',
        InputAligner.setupDispatchTimer: '(self, node, update_rate)',
    }
    for thing, expected in known.items():
        signature = inspect.signature(thing)
        bare = [p.replace(annotation=p.empty) for p in signature.parameters.values()]
        for number, parameter in enumerate(bare):
            if parameter.default == QoSProfile(depth=10):
                bare[number] = parameter.replace(default=10)
        assert str(inspect.Signature(bare)) == expected, thing
    assert {name for name in dir(Cache) if name.startswith('get')} == {
        'getElemAfterTime',
        'getElemBeforeTime',
        'getInterval',
        'getLast',
        'getLastestTime',
        'getOldestTime',
    }
    assert len(message_filters.__all__) == 6


def test_callbacks_get_messages_and_then_their_arguments() -> None:
    source, heard = SimpleFilter(), list[Any]()
    first = source.registerCallback(lambda *words: heard.append(words), 'x', 'y')
    second = source.registerCallback(lambda *words: heard.append(words))
    assert (first, second) == (0, 1)
    source.signalMessage(1, 2)
    assert heard == [(1, 2, 'x', 'y'), (1, 2)]
    source.unregisterCallback(first)
    source.unregisterCallback(99)
    assert source.registerCallback(lambda _: heard.append('new')) == 2  # and 1 keeps its place
    heard.clear()
    source.signalMessage(3)
    assert heard == [(3,), 'new']


def test_a_callback_may_register_another() -> None:
    source, heard = SimpleFilter(), list[Any]()
    source.registerCallback(lambda _: source.registerCallback(heard.append))
    source.signalMessage(1)
    assert heard == []
    source.signalMessage(2)
    assert heard == [2]


def test_what_is_no_callback_and_what_is_no_filter_is_refused() -> None:
    with pytest.raises(TypeError, match='callback=None cannot be called; hand over the function'):
        SimpleFilter().registerCallback(None)  # type: ignore[arg-type]
    for kind in (Cache, Chain, lambda f: TimeSynchronizer([f], 1), lambda f: DeltaFilter([], f)):
        with pytest.raises(AttributeError, match=r'no filter; .*Subscriber\(node, msg_type, top'):
            kind(String())
    with pytest.raises(TypeError, match=r'topic=.*String.*: must be the name of a topic'):
        Subscriber(None, '/topic', String)  # type: ignore[arg-type]


def test_a_cache_is_asked_by_time() -> None:
    source = SimpleFilter()
    cache, through = Cache(source, 3), list[Any]()
    cache.registerCallback(through.append)
    assert (cache.getLast(), cache.getOldestTime(), cache.getLastestTime()) == (None, None, None)
    assert (cache.getInterval(when(0), when(9)), cache.getElemAfterTime(when(0))) == ([], None)
    messages = [at(t) for t in (10, 20, 30, 40)]
    for message in messages:
        source.signalMessage(message)
    assert through == messages
    assert cache.cache_msgs == messages[1:]  # as many as it may keep
    assert (cache.getOldestTime(), cache.getLastestTime()) == (when(20), when(40))
    assert cache.getInterval(when(20), when(30)) == messages[1:3]
    assert cache.getInterval(when(21), when(29)) == []
    assert cache.getInterval(when(30), when(30)) == messages[2:3]
    assert cache.getElemAfterTime(when(30)) is messages[2]
    assert cache.getElemAfterTime(when(41)) is None
    assert cache.getElemBeforeTime(when(39)) is messages[2]
    assert cache.getElemBeforeTime(when(40)) is messages[3]
    assert cache.getElemBeforeTime(when(19)) is None
    assert cache.getLast() is messages[3]
    source.signalMessage(at(25))  # late: kept as the newest, as upstream
    assert cache.getLastestTime() == when(25)
    assert cache.getLast() is messages[2]
    assert cache.getElemAfterTime(when(24)) is messages[2]


def test_a_cache_refuses_times_that_it_cannot_compare() -> None:
    cache = Cache(SimpleFilter(), 3)
    cache.add(at(10))
    with pytest.raises(AssertionError, match=r'from_stamp=.*is after to_stamp='):
        cache.getInterval(when(2), when(1))
    with pytest.raises(
        TypeError, match=r'different clock types: .*clock_type=ClockType\.ROS_TIME'
    ):
        cache.getElemAfterTime(Time())
    with pytest.raises(TypeError, match=r'is no rclpy\.time\.Time; of a message that is Time\.fr'):
        cache.getElemBeforeTime(TimeMsg())


def test_a_cache_keeps_messages_without_stamp_where_it_may() -> None:
    before = ROSClock().now()
    cache = Cache(SimpleFilter(), cache_size=5, allow_headerless=True)
    cache.add(String(data='a'))
    after = ROSClock().now()
    cache.add(String(data='b'))
    assert cache.getInterval(before, after) == [String(data='a')]
    assert cache.getElemAfterTime(after) == String(data='b')


def test_filters_of_a_chain_come_one_after_another() -> None:
    source = SimpleFilter()
    chain, ends = Chain(source), list[Any]()
    chain.registerCallback(ends.append)
    source.signalMessage(at(1))
    with pytest.raises(KeyError, match='index=0: the chain has 0 filters'):
        chain.getFilter(0)
    first, second = Cache(SimpleFilter(), 9), Cache(SimpleFilter(), 9)
    chain.addFilter(first)
    aside: list[Any] = []
    first.registerCallback(aside.append)
    source.signalMessage(at(2))
    chain.addFilter(second)
    source.signalMessage(at(3))
    assert ends == [at(1), at(2), at(3)]
    assert (first.cache_msgs, second.cache_msgs) == ([at(2), at(3)], [at(3)])
    assert aside == [at(2), at(3)]  # a callback of one's own stays
    assert (chain.getFilter(0), chain.getFilter(1)) == (first, second)
    with pytest.raises(RuntimeError, match='Already connected'):
        chain.connectInput(source)
    alone = Chain()
    alone.registerCallback(ends.append)
    alone.add(at(4))  # without an input
    assert ends[3:] == [at(4)]


def test_what_has_not_changed_is_not_let_out() -> None:
    heard: list[Any] = []
    source = SimpleFilter()
    DeltaFilter([lambda msg: msg.data], source).registerCallback(heard.append)
    for text in 'aabba':
        source.signalMessage(String(data=text))
    assert [message.data for message in heard] == ['a', 'b', 'a']
    points = SimpleFilter()
    paths = PathDeltaFilter(['header.frame_id', 'point.x'], points)
    heard.clear()
    paths.registerCallback(heard.append)
    for frame, t in (('a', 1), ('a', 2), ('b', 3)):
        points.signalMessage(at(t, frame))
    assert [message.header.frame_id for message in heard] == ['a', 'b']


def test_what_cannot_be_compared_is_refused() -> None:
    compare = DeltaCompare([lambda msg: msg.header])
    assert compare.message_fits(at(1))  # the first is compared with none
    with pytest.raises(TypeError, match='a field of type Header: take bool, int, float or str'):
        compare.message_fits(at(2))
    with pytest.raises(RuntimeError, match=r"'point\.w': Point has no field 'w'"):
        PathDeltaFilter([]).get_field_by_path(at(1), 'point.w')
    with pytest.raises(NotImplementedError, match='needs a method message_fits'):
        ComparisonHandler().message_fits(at(1))
    with pytest.raises(RuntimeError, match='Already connected: a DeltaFilter has one input'):
        DeltaFilter([], SimpleFilter()).connectInput(SimpleFilter())


def test_a_handler_of_ones_own_decides() -> None:
    class Later(CachedComparisonHandler):
        _field_getters = (lambda msg: msg.header.stamp.nanosec,)

        def do_fields_fit(self, field_a: int, field_b: int) -> bool:
            return field_b > field_a

    heard: list[Any] = []
    later = ComparisonFilter(Later())
    later.registerCallback(heard.append)
    for t in (2, 1, 3):
        later.add(at(t))
    assert heard == [at(2), at(3)]


class Aligned:
    """An aligner of filters, and what comes out of it, as milliseconds."""

    def __init__(self, count: int, timeout_ms: int = 1000, period_ms: int = 0) -> None:
        self.filters = [SimpleFilter() for _ in range(count)]
        self.aligner = InputAligner(Duration(nanoseconds=timeout_ms * MS), self.filters)
        self.heard: list[int] = []
        for index in range(count):
            self.aligner.registerCallback(index, self._on_message)
            self.aligner.setInputPeriod(index, Duration(nanoseconds=period_ms * MS))

    def _on_message(self, message: PointStamped) -> None:
        self.heard.append(message.header.stamp.nanosec // MS)

    def hear(self, index: int, *stamps: int) -> None:
        for stamp in stamps:
            self.filters[index].signalMessage(at(stamp))

    def dispatched(self) -> list[int]:
        self.heard.clear()
        self.aligner.dispatchMessages()
        return list(self.heard)


def test_messages_are_aligned_by_their_stamps() -> None:
    four = Aligned(4, period_ms=4)
    for index, stamps in {2: (7, 3), 0: (1, 5, 9, 9), 3: (2, 6), 1: (4, 8)}.items():
        four.hear(index, *stamps)
    assert four.dispatched() == [1, 2, 3, 4, 5, 6, 7, 8, 9, 9]
    assert four.dispatched() == []


def test_an_input_is_waited_for_until_it_is_too_late() -> None:
    two = Aligned(2, timeout_ms=10, period_ms=2)
    two.hear(0, *range(1, 17, 2))
    two.hear(1, 2, 4)
    assert two.dispatched() == [1, 2, 3, 4, 5]  # 6 is expected of the other
    two.hear(0, 17)
    assert two.dispatched() == [7, 9, 11, 13, 15, 17]
    two.hear(0, 16)
    assert two.dispatched() == []
    assert two.aligner.getQueueStatus(0) == QueueStatus(True, 0, 9, 1)
    assert two.aligner.getQueueStatus(1) == QueueStatus(False, 0, 2, 0)
    three = Aligned(3, timeout_ms=10)
    for index, stamps in {0: (6,), 2: (2, 4), 1: (1, 3, 5)}.items():
        three.hear(index, *stamps)
    assert three.dispatched() == [1, 2, 3, 4]
    three.hear(0, 14)
    assert three.dispatched() == [5]  # 10 after 4, and not yet after 5
    three.hear(0, 16)
    assert three.dispatched() == [6, 14, 16]


def test_an_aligner_forgets_inputs() -> None:
    two = Aligned(2)
    two.aligner.disconnectAll()
    two.hear(0, 1)
    assert two.dispatched() == []
    two.aligner.connectInput(filters=two.filters[:1])
    two.hear(0, 2)
    two.hear(1, 3)
    assert two.dispatched() == []  # its callbacks went too
    with pytest.raises(IndexError, match='index=1: there are 1 inputs, the first is 0'):
        two.aligner.registerCallback(1, print)
    two.aligner.setName('front')
    assert (two.aligner.getName(), InputAligner(Duration()).getName()) == ('front', '')
