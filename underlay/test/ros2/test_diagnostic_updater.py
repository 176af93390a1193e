# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""diagnostic_updater: what nodes publish on /diagnostics, and what each task finds good or bad."""

from __future__ import annotations

from collections.abc import Callable
import inspect
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import diagnostic_updater
from diagnostic_updater import (
    _update_functions,
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    FrequencyStatus,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    TopicDiagnostic,
    Updater,
)
from geometry_msgs.msg import PointStamped
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import Header

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def says(level: bytes, message: str) -> Callable[[Any], Any]:
    """Return a function for a task, which adds a pair as well."""

    def fill(stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.summary(level, message)
        stat.add('by', message)
        return stat

    return fill


class Listener:
    """A node that makes statuses, and one that hears those on /diagnostics."""

    def __init__(self, nodes: SpunNodes, **parameters: Any) -> None:
        self.heard: list[DiagnosticStatus] = []
        listening = nodes.start(Node, 'listener')
        listening.create_subscription(
            DiagnosticArray, '/diagnostics', lambda msg: self.heard.extend(msg.status), 100
        )
        self.node = nodes.start(Node, 'driver', **parameters)
        wait_until(
            lambda: self.node.count_subscribers('/diagnostics') == 1,
            timeout_sec=10.0,
            what='a listener',
        )
        self.updater = Updater(self.node, 60.0)
        wait_until(
            lambda: self.updater.publisher.get_subscription_count() == 1,
            timeout_sec=10.0,
            what='a listener that is matched',
        )

    def until(self, level: bytes, name: str, message: str) -> DiagnosticStatus:
        """Wait for a status, and return it."""

        def those() -> list[DiagnosticStatus]:
            looked_for = (level, name, message)
            return [s for s in [*self.heard] if (s.level, s.name, s.message) == looked_for]

        wait_until(
            lambda: bool(those()),
            timeout_sec=10.0,
            what=lambda: f'{name}: {message}; there are {self.heard}',
        )
        return those()[0]


def test_tasks_are_published_under_the_name_of_the_node(
    domain: int, capfd: pytest.CaptureFixture[str]
) -> None:
    with SpunNodes(domain) as nodes:
        driver = Listener(nodes)
        updater = driver.updater
        updater.add('motor', says(OK, 'turns'))
        driver.until(OK, 'driver: motor', 'Node starting up')
        updater.add(Heartbeat())
        driver.until(OK, 'driver: Heartbeat', 'Node starting up')
        updater.force_update()
        driver.until(OK, 'driver: Heartbeat', 'Alive')
        assert driver.until(OK, 'driver: motor', 'turns').hardware_id == ''
        updater.force_update()
        updater.setHardwareID('left')
        updater.verbose = True
        updater.add('sensor', lambda stat: stat)
        updater.force_update()
        assert driver.until(ERROR, 'driver: sensor', 'No message was set').hardware_id == 'left'
        err = capfd.readouterr().err
        assert err.count('No HW_ID was set') == 1
        assert "Non-zero diagnostic status. Name: sensor, status b'\\x02': No message" in err
        updater.broadcast(WARN, 'is ending')
        driver.until(WARN, 'driver: motor', 'is ending')
        assert updater.removeByName('motor')
        assert not updater.removeByName('motor')
        driver.heard.clear()
        updater.force_update()
        driver.until(OK, 'driver: Heartbeat', 'Alive')
        assert not [status for status in driver.heard if status.name == 'driver: motor']


def test_it_publishes_by_itself_at_the_period_of_the_parameter(domain: int) -> None:
    parameters = {'diagnostic_updater.period': 30.0, 'diagnostic_updater.use_fqn': True}
    with SpunNodes(domain) as nodes:
        driver = Listener(nodes, **parameters)
        assert driver.updater.period == 30.0
        driver.updater.add('motor', says(OK, 'turns'))
        driver.updater.period = 0.02
        driver.until(OK, '//driver: motor', 'turns')
        assert [*driver.node.timers] == [driver.updater.timer], 'the timer before has to go'


def test_a_publisher_tells_of_its_messages(domain: int) -> None:
    with SpunNodes(domain) as nodes:
        driver = Listener(nodes)
        bound = FrequencyStatusParam({'min': 0.01}, window_size=1)
        points = driver.node.create_publisher(PointStamped, 'points', 10)
        heard: list[PointStamped] = []
        driver.node.create_subscription(PointStamped, 'points', heard.append, 10)
        wait_until(
            lambda: points.get_subscription_count() == 1,
            timeout_sec=10.0,
            what='a subscription of the points',
        )
        diagnosed = DiagnosedPublisher(points, driver.updater, bound, TimeStampStatusParam())
        message = PointStamped(header=Header(stamp=driver.node.get_clock().now().to_msg()))
        diagnosed.publish(message)
        wait_until(lambda: heard == [message], timeout_sec=10.0, what='the message itself')
        driver.updater.force_update()
        good = 'Desired frequency met; Timestamps are reasonable.'
        status = driver.until(OK, 'driver: /points topic status', good)
        assert status.values[0].value == '1'
        diagnosed.tick(driver.node.get_clock().now())
        diagnosed.clear_window()
        driver.updater.force_update()
        driver.until(ERROR, 'driver: /points topic status', 'No events recorded.')
        diagnosed.publish(PointStamped(header=Header(stamp=Time(seconds=1).to_msg())))
        driver.updater.force_update()
        late = 'Timestamps too far in past seen.'
        driver.until(ERROR, 'driver: /points topic status', late)


def test_the_interface_is_that_of_jazzy() -> None:
    known: dict[Callable[..., Any], str] = {
        Updater: '(node, period=1.0)',
        FunctionDiagnosticTask: '(name, fn)',
        CompositeDiagnosticTask: '(name)',
        FrequencyStatusParam: '(freq_bound, tolerance=0.1, window_size=5)',
        FrequencyStatus: "(params, name='FrequencyStatus')",
        TimeStampStatusParam: '(min_acceptable=-1, max_acceptable=5)',
        HeaderlessTopicDiagnostic: '(name, diag, freq)',
        TopicDiagnostic: '(name, diag, freq, stamp)',
        DiagnosedPublisher: '(pub, diag, freq, stamp)',
    }
    for made, expected in known.items():
        bare = inspect.signature(made)
        plain = [each.replace(annotation=each.empty) for each in bare.parameters.values()]
        assert str(inspect.Signature(plain)) == expected
    for name in diagnostic_updater.__all__:
        assert getattr(diagnostic_updater, name)


@pytest.mark.parametrize(
    ('before', 'new', 'after'),
    [
        ((OK, 'fine'), (WARN, 'hot'), (WARN, 'hot')),
        ((WARN, 'hot'), (OK, 'fine'), (WARN, 'hot')),
        ((WARN, 'hot'), (ERROR, 'off'), (ERROR, 'hot; off')),
        ((ERROR, 'off'), (WARN, 'hot'), (ERROR, 'off; hot')),
        ((OK, 'fine'), (OK, 'cold'), (OK, 'fine; cold')),
        ((OK, ''), (OK, 'cold'), (OK, 'cold')),
    ],
)
def test_of_two_summaries_the_worse_counts(before: Any, new: Any, after: Any) -> None:
    stat = DiagnosticStatusWrapper(level=before[0], message=before[1])
    stat.mergeSummary(*new)
    assert (stat.level, stat.message) == after
    tasks = CompositeDiagnosticTask('both')
    tasks.addTask(FunctionDiagnosticTask('one', says(*before)))
    tasks.addTask(FunctionDiagnosticTask('two', says(*new)))
    both = tasks.run(DiagnosticStatusWrapper())
    assert (both.level, both.message) == after
    assert [pair.value for pair in both.values] == [before[1], new[1]]
    stat.clearSummary()
    assert (stat.level, stat.message) == (OK, '')


def test_a_task_of_several_does_not_see_what_the_one_before_said() -> None:
    tasks = CompositeDiagnosticTask('both')
    tasks.addTask(FunctionDiagnosticTask('one', says(WARN, 'hot')))
    tasks.addTask(FunctionDiagnosticTask('silent', lambda stat: stat))
    both = tasks.run(DiagnosticStatusWrapper(level=ERROR, message='nothing yet'))
    assert (both.level, both.message) == (ERROR, 'hot; nothing yet')


@pytest.fixture
def at(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Return a function that sets the time of the tasks, in s."""

    def set_time(sec: float) -> None:
        monkeypatch.setattr(_update_functions, '_now', lambda: Time(nanoseconds=round(sec * 1e9)))

    set_time(100.0)
    return set_time


@pytest.mark.parametrize(
    ('events', 'level', 'message'),
    [
        (0, ERROR, 'No events recorded.'),
        (7, WARN, 'Frequency too low.'),
        (8, OK, 'Desired frequency met'),
        (24, OK, 'Desired frequency met'),
        (25, WARN, 'Frequency too high.'),
    ],
)
def test_events_are_counted_in_their_window(
    at: Callable[[float], None], events: int, level: bytes, message: str
) -> None:
    status = FrequencyStatus(FrequencyStatusParam({'min': 5, 'max': 10}, 0.2, 2))
    at(101.0)
    status.run(DiagnosticStatusWrapper())
    for _ in range(events):
        status.tick()
    at(102.0)
    stat = status.run(DiagnosticStatusWrapper())
    assert (stat.level, stat.message) == (level, message)
    assert {pair.key: pair.value for pair in stat.values} == {
        'Events in window': f'{events}',
        'Events since startup': f'{events}',
        'Duration of window (s)': '2.000000',
        'Actual frequency (Hz)': f'{events / 2:f}',
        'Minimum acceptable frequency (Hz)': '4.000000',
        'Maximum acceptable frequency (Hz)': '12.000000',
    }


def test_what_has_stopped_is_bad_when_its_window_is_over(at: Callable[[float], None]) -> None:
    status = FrequencyStatus(FrequencyStatusParam({'min': 2.0}, 0.0, 3))
    told = []
    for sec in range(1, 9):
        if sec <= 4:
            status.tick()
            status.tick()
        at(100.0 + sec)
        stat = status.run(DiagnosticStatusWrapper())
        told.append((stat.message.split()[-1], stat.values[0].value, stat.values[2].value[:1]))
    met = ('met', '6', '3')
    assert told == [
        *[('met', '2', '1'), ('met', '4', '2'), met, met],
        *[('low.', '4', '3'), ('low.', '2', '3'), *2 * [('recorded.', '0', '3')]],
    ]


def test_equal_bounds_are_a_target(at: Callable[[float], None]) -> None:
    bound = {'min': 0.0}
    status = FrequencyStatus(FrequencyStatusParam(bound))
    keys = [pair.key for pair in status.run(DiagnosticStatusWrapper()).values]
    assert keys[4:] == [], 'no bound above, none below, and no time has passed'
    bound.update(min=2.0, max=2.0)
    at(101.0)
    keys = [pair.key for pair in status.run(DiagnosticStatusWrapper()).values]
    assert keys[4] == 'Target frequency (Hz)'


@pytest.mark.parametrize(
    ('ages_sec', 'level', 'message'),
    [
        ((), WARN, 'No data since last update.'),
        ((0.0, 5.0, -1.0), OK, 'Timestamps are reasonable.'),
        ((5.1, 0.0), ERROR, 'Timestamps too far in past seen.'),
        ((-1.1, 0.0), ERROR, 'Timestamps too far in future seen.'),
        ((100.0, 0.0), ERROR, 'Zero timestamp seen.'),
        ((100.0,), WARN, 'No data since last update.'),
    ],
)
def test_stamps_have_to_be_of_now(
    at: Callable[[float], None], ages_sec: tuple[float, ...], level: bytes, message: str
) -> None:
    status = TimeStampStatus()
    for age_sec in ages_sec:
        status.tick(Time(nanoseconds=round((100.0 - age_sec) * 1e9)))
        status.tick(100.0 - age_sec)
    stat = status.run(DiagnosticStatusWrapper())
    assert (stat.level, stat.message) == (level, message)
    again = status.run(DiagnosticStatusWrapper())
    assert again.message == 'No data since last update.'
    assert [pair.value for pair in again.values[:2]] == ['0.000000', '0.000000']
    counts = [pair.value for pair in again.values[4:]]
    assert sorted(counts) == ['0', '0', '1' if level == ERROR else '0']


def test_what_is_wrong_is_told_with_what_to_write() -> None:
    stat: Any = DiagnosticStatusWrapper()
    tasks = diagnostic_updater.DiagnosticTaskVector()
    tasks.add('motor', DiagnosticStatusWrapper.clearSummary)
    for refused, why in (
        (lambda: stat.add('speed', 0.5), r"add\('speed', 0.5\): .* write str\(0.5\)"),
        (lambda: stat.mergeSummary(), 'mergeSummary takes a status, or a level and a message'),
        (lambda: tasks.add(), 'add takes a task, or a name and a function, not 0 values'),
        (lambda: tasks.tasks[0].run(stat), "the task 'motor' returned None: it has to end with"),
        (lambda: TimeStampStatus().tick(Time().to_msg()), 'is no stamp: a float of s is one, or'),
    ):
        with pytest.raises(TypeError, match=why):
            refused()
