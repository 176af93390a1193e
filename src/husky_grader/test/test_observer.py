# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the grader's own node takes for heard, of all that a program prints; how long it waits."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
import os
from pathlib import Path
import subprocess
import sys
import time

from husky_grader.lab.observer import new_token, observe
from husky_grader.lab.patience import crowding
from husky_grader.rubric.steps import FieldCheck, PublisherStep, ServiceStep, SubscriberStep
from husky_grader.run.printed import MAX_AROUND, MAX_LINES, printed_lines
from playpen_testing.busy import busy_machine
from playpen_testing.waiting import wait_until
import pytest

TOKEN = 12_345_678
STEP = SubscriberStep(
    points=10.0,
    package='zoo',
    executable='guesses',
    topic='/topic_test',
    type='std_msgs/msg/String',
    sent={'data': 'hello grader {token}'},
    printed='heard<text>hello grader {token}',
    within_sec=0.3,
)

# Its first answer is lost as on a busy machine, where rmw_fastrtps has found the client too late.
LOSES_AN_ANSWER = """
import sys
import warnings

import rclpy
from rclpy.service import Service
from std_srvs.srv import SetBool

really_send, lost = Service.send_response, []

def send_response(service, response, header):
    if lost:
        return really_send(service, response, header)
    lost.append(response)
    if sys.argv[1:]:
        warnings.warn(sys.argv[1], RuntimeWarning)

def answer(request, response):
    response.success = request.data
    return response

Service.send_response = send_response
rclpy.init()
node = rclpy.create_node('motor')
node.create_service(SetBool, '/flip', answer)
rclpy.spin(node)
"""
WARNING = (
    'failed to send response (timeout): client will not receive response, at rmw_response.cpp'
)

COUNTS = """
import sys
import time

import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node('counter')
publisher = node.create_publisher(Int32, 'count', 10)
while publisher.get_subscription_count() == 0:
    time.sleep(0.01)
for number in range(int(sys.argv[1])):
    publisher.publish(Int32(data=number))
    time.sleep(0.1)
rclpy.spin(node)
"""


@pytest.fixture(autouse=True)
def graph(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')


@contextmanager
def running(code: str, *words: str, log: Path) -> Iterator[Callable[[], bool]]:
    """Run a program, and give what tells whether it has ended."""
    program = [sys.executable, '-c', code, *words]
    with (
        log.open('w') as out,
        subprocess.Popen(program, stdout=out, stderr=subprocess.STDOUT) as process,
    ):
        try:
            yield lambda: process.poll() is not None
        finally:
            process.kill()


def test_a_number_is_not_heard_by_who_does_not_listen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('husky_grader.lab.observer.random.randint', lambda *_: TOKEN)
    (tmp_path / 'log').write_text(f'heard hello grader {TOKEN}\n')
    found = observe(STEP, lambda: False, tmp_path / 'log', tmp_path)
    assert found.score == 0.0
    assert found.why == 'it listens to nothing; the lab asks for /topic_test'


@pytest.mark.parametrize(
    ('kind', 'sent', 'most'),
    [
        ('std_msgs/msg/String', {'data': 'hello {token}'}, 10**12),
        ('std_msgs/msg/Header', {'frame_id': '{token}', 'stamp': {'sec': 1}}, 10**12),
        ('sensor_msgs/msg/JointState', {'name': ['a', '{token}']}, 10**12),
        ('std_msgs/msg/Float32', {'data': '{token}'}, 2**24),
        ('std_msgs/msg/Int32', {'data': '{token}'}, 2**24),
        ('std_msgs/msg/Header', {'frame_id': '{token}', 'stamp': {'sec': '{token}'}}, 2**24),
        ('std_msgs/msg/Float64MultiArray', {'data': ['{token}']}, 2**24),
    ],
)
def test_a_number_in_a_text_is_one_of_more_than_a_program_can_print(
    kind: str, sent: dict[str, object], most: int
) -> None:
    token = int(new_token(replace(STEP, type=kind, sent=sent)))
    assert most / 10 <= token <= most


def test_it_waits_longer_for_a_program_that_gets_less_of_a_processor(tmp_path: Path) -> None:
    asked_sec: list[float] = []  # when it asked whether the program is over: as long as it waits

    def is_over() -> bool:
        asked_sec.append(time.monotonic())
        return False

    (tmp_path / 'log').touch()
    with busy_machine(8 * (os.cpu_count() or 1), nice=19):
        wait_until(lambda: crowding() > 6.0, timeout_sec=30.0, what='eight for each processor')
        found = observe(STEP, is_over, tmp_path / 'log', tmp_path)
    assert found.why == 'it listens to nothing; the lab asks for /topic_test'
    waited_sec = asked_sec[-1] - asked_sec[0]
    assert waited_sec > 4.0 * STEP.within_sec, 'it waited as on a machine with nothing else to do'


def test_a_word_is_found_wherever_it_was_printed(tmp_path: Path) -> None:
    log, other = tmp_path / 'log', 'another line\n' * 10_000
    log.write_text(f'{other}[INFO] heard {TOKEN}\r\n{other}it was {TOKEN}, {TOKEN}')
    assert printed_lines(log, str(TOKEN)) == [f'[INFO] heard {TOKEN}', f'it was {TOKEN}, {TOKEN}']
    assert printed_lines(tmp_path / 'none', str(TOKEN)) == []
    log.write_text('x' * 1_000_000 + str(TOKEN) + 'y' * 1_000_000 + f'\n{TOKEN}' * 1_000)
    first, *others = printed_lines(log, str(TOKEN))
    assert len(first) == 2 * MAX_AROUND
    assert others == [str(TOKEN)] * (MAX_LINES - 1)


@pytest.mark.parametrize(
    ('warning', 'score', 'why'),
    [((WARNING,), 100.0, ''), ((), 0.0, '/flip did not answer within 2 s: does its callback')],
    ids=['lost', 'not sent'],
)
def test_a_response_that_the_machine_has_lost_is_asked_for_again(
    warning: tuple[str, ...], score: float, why: str, tmp_path: Path
) -> None:
    log = tmp_path / 'log'
    step = ServiceStep(
        points=10.0,
        package='zoo',
        executable='motor',
        service='/flip',
        type='std_srvs/srv/SetBool',
        request={'data': True},
        response=(FieldCheck(field='success', equals=True),),
        within_sec=2.0,
    )
    with running(LOSES_AN_ANSWER, *warning, log=log) as is_over:
        found = observe(step, is_over, log, tmp_path)
    assert (found.score, found.why[: len(why)]) == (score, why), log.read_text()


@pytest.mark.parametrize(
    ('messages', 'defects'),
    [
        (1000, {}),
        (
            7,
            {
                'rate': 'it stopped: nothing came any more within 5 s; '
                'the lab asks for 10 messages a second, without an end'
            },
        ),
    ],
)
def test_who_stops_after_some_messages_has_no_rate(
    messages: int, defects: dict[str, str], tmp_path: Path
) -> None:
    step = PublisherStep(
        points=10.0,
        package='zoo',
        executable='counts',
        topic='/count',
        type='std_msgs/msg/Int32',
        rate_hz=10.0,
        within_sec=5.0,
        listen_sec=1.0,
    )
    log = tmp_path / 'log'
    with running(COUNTS, str(messages), log=log) as is_over:
        found = observe(step, is_over, log, tmp_path)
    assert (found.why, found.score) == ('10 Hz on /count, std_msgs/msg/Int32', 100.0)
    assert found.defects == defects, log.read_text()
