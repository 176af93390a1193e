# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The publisher and the subscriber of the sheet as real processes, started as students do."""

from itertools import pairwise
import re
import signal
from statistics import median

from playpen_testing.processes import Process, Processes
from playpen_testing.waiting import wait_until

HELLO = re.compile(r'hello world (\d+\.\d+)')
HEARD = re.compile(r'(/subscriber_\d+_\d+) heard hello world \d+\.\d+')


def run(processes: Processes, executable: str, *arguments: str) -> Process:
    return processes.start('ros2', 'run', 'topic_demo', executable, *arguments)


def names_heard(subscriber: Process) -> set[str]:
    return {match[1] for line in subscriber.lines if (match := HEARD.search(line))}


def test_the_publisher_logs_ten_hellos_a_second(processes: Processes) -> None:
    publisher = run(processes, 'publisher')
    wait_until(
        lambda: len(HELLO.findall(publisher.output)) >= 21,
        timeout_sec=20.0,
        what=lambda: f'21 hellos; printed:\n{publisher.output}',
    )
    times = [float(text) for text in HELLO.findall(publisher.output)][:21]
    # The middle one: where the machine holds it up for a moment, that moment is of one or two.
    assert 0.095 < median(after - before for before, after in pairwise(times)) < 0.115, times
    assert '[INFO]' in publisher.lines[0]


def test_two_named_subscribers_hear_two_publishers(processes: Processes) -> None:
    subscribers = [run(processes, 'subscriber') for _ in range(2)]
    for _ in range(2):
        run(processes, 'publisher')
    for subscriber in subscribers:
        subscriber.wait_for_text(' heard hello world ')
    names = [names_heard(subscriber) for subscriber in subscribers]
    assert [len(own) for own in names] == [1, 1]
    assert names[0] != names[1]


def test_a_name_and_a_topic_given_by_the_user_win(processes: Processes) -> None:
    subscriber = run(
        processes, 'subscriber', '--ros-args', '-r', '__node:=me', '-r', 'topic_test:=other'
    )
    run(processes, 'publisher', '--ros-args', '-r', 'topic_test:=other')
    subscriber.wait_for_text('/me heard hello world ')


def test_ctrl_c_ends_both_with_no_traceback(processes: Processes) -> None:
    both = [run(processes, name) for name in ('publisher', 'subscriber')]
    both[1].wait_for_text(' heard ')
    for process in both:
        process.signal(signal.SIGINT)
    for process in both:
        process.wait(timeout_sec=2.0)
        assert 'Traceback' not in process.output
