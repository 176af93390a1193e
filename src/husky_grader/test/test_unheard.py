# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A program of which nothing is heard, or that prints nothing, is told why."""

from dataclasses import replace
import os
from pathlib import Path
import sys

from husky_grader.jail import find_sandbox
from husky_grader.lab.finding import Finding
from husky_grader.lab.live_steps import live_step
from husky_grader.lab.programs import Programs
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import ProgramStep, PublisherStep, ServiceStep, SubscriberStep
import pytest

WAITS = """#!%s
import rclpy
from std_srvs.srv import Empty, Trigger
rclpy.init()
node = rclpy.create_node('sensor')
other = node.create_client(Empty, 'zero')
node.create_service(Empty, 'zero', lambda request, response: response)
node.create_service(Trigger, 'tare', lambda request, _: other.call(Empty.Request()))
rclpy.spin(node)
"""
STEPS = load_rubric(default_rubric()).steps
(PUBLISHES,) = (replace(s, within_sec=3.0) for s in STEPS if isinstance(s, PublisherStep))
(LISTENS,) = (replace(s, within_sec=3.0) for s in STEPS if isinstance(s, SubscriberStep))
TARES = ServiceStep(
    points=10.0,
    package='sensor',
    executable='sensor',
    service='/tare',
    type='std_srvs/srv/Trigger',
    within_sec=3.0,
)
PUBLISHER = """#!%s
import time, rclpy
from std_msgs.msg import String
rclpy.init()
publisher = rclpy.create_node('publisher').create_publisher(String, '%s', 10)
for number in range(1000):
    if number >= %d:
        publisher.publish(String(data=f'hello world {time.time()}'))
    time.sleep(0.1)
"""
SIMULATED = """#!%s
import rclpy
from std_msgs.msg import String
rclpy.init(args=['--ros-args', '-p', 'use_sim_time:=true'])
node = rclpy.create_node('publisher')
publisher = node.create_publisher(String, 'topic_test', 10)
node.create_timer(0.1, lambda: publisher.publish(String(data='hello world 1')))
rclpy.spin(node)
"""
SUBSCRIBER = """#!%s
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('subscriber')
node.create_subscription(String, 'topic_test', lambda m: print(%s, flush=True), 10)
rclpy.spin(node)
"""


@pytest.fixture(autouse=True)
def graph(courses: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let programs find each other quickly."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(courses.parent / 'fastdds.xml'))


def found_of(step: ProgramStep, folder: Path, program: str, sandbox: str = 'none') -> Finding:
    """Run a program as that of a step, and return what is found out about it."""
    package = folder / 'workspace' / 'src' / step.package
    package.mkdir(parents=True)
    (package / 'package.xml').write_text(f'<package><name>{step.package}</name></package>')
    built = folder / 'built'
    file = built / 'install' / step.package / 'lib' / step.package / step.executable
    file.parent.mkdir(parents=True)
    file.write_text(program)
    file.chmod(0o755)
    environment = {name: value for name, value in os.environ.items() if name != 'HOME'}
    programs = Programs(folder / 'workspace', built, environment, find_sandbox(sandbox))
    return live_step(step, programs, folder / 'log')


@pytest.mark.parametrize(
    ('program', 'why'),
    [
        (
            PUBLISHER % (sys.executable, 'topic_text', 0),
            'it publishes on /topic_text; the lab asks for /topic_test',
        ),
        (f'#!{sys.executable}\ndef main(:\n    pass\n', 'publisher line 2: SyntaxError: '),
        (f'#!{sys.executable}\nimport os\nos._exit(7)\n', 'it ended by itself (exit code 7)'),
        ('#!/no/such/python\n', 'publisher cannot be started: there is no such program'),
        (
            PUBLISHER % (sys.executable, 'topic_test', 900),
            'nothing came on /topic_test within 3 s; it has a publisher there: does it publish',
        ),
        (
            SIMULATED % sys.executable,
            'nothing came on /topic_test within 3 s; its clock is that of /clock (use_sim_time)',
        ),
    ],
    ids=['another topic', 'a syntax error', 'an exit', 'no interpreter', 'silence', 'sim time'],
)
def test_a_publisher_that_is_not_heard_is_told_why(tmp_path: Path, program: str, why: str) -> None:
    found = found_of(PUBLISHES, tmp_path, program)
    assert found.score == 0.0
    assert found.why.startswith(why), found.why


@pytest.mark.parametrize(
    ('topic', 'shown', 'why'),
    [
        (
            'topic_test',
            '""',
            'it did not print what came on /topic_test; does it spin, and does its',
        ),
        ('topic', 'm.data', 'it listens to /topic; the lab asks for /topic_test'),
    ],
)
def test_a_subscriber_that_does_not_hear_is_told_why(
    tmp_path: Path, topic: str, shown: str, why: str
) -> None:
    program = SUBSCRIBER % (sys.executable, shown)
    program = program.replace("'topic_test'", f"'{topic}'")
    # Its own publisher, which has nothing to do with what it should hear.
    program = program.replace(
        'rclpy.spin', f"talks = node.create_publisher(String, '{topic}', 1)\nrclpy.spin"
    )
    found = found_of(LISTENS, tmp_path, program)
    assert found.score == 0.0
    assert found.why.startswith(why), found.why


@pytest.mark.parametrize(
    ('step', 'program', 'says'),
    [
        (PUBLISHES, PUBLISHER % (sys.executable, 'topic_test', 0), 'nothing came on /topic_test'),
        (LISTENS, SUBSCRIBER % (sys.executable, 'm.data'), ''),
        (TARES, WAITS % sys.executable, ''),
    ],
    ids=['publisher', 'subscriber', 'service'],
)
def test_a_program_that_chooses_its_own_domain_is_told(
    tmp_path: Path, step: ProgramStep, program: str, says: str
) -> None:
    program = program.replace('rclpy.init()', 'rclpy.init(domain_id=77)')
    found = found_of(step, tmp_path, program, 'kernel')
    assert found.score == 0.0
    assert found.why.startswith(says)
    assert found.why.endswith(
        'it is in domain 77, where nobody hears it: leave ROS_DOMAIN_ID and domain_id to who '
        'starts it'
    ), found.why
    # In a network that others use, too, it could be theirs.
    assert 'domain' not in found_of(step, tmp_path / 'shared', program).why


def test_a_service_that_does_not_answer_is_told_what_may_keep_it(tmp_path: Path) -> None:
    found = found_of(TARES, tmp_path, WAITS % sys.executable)
    assert found.score == 0.0
    assert found.why == (
        '/tare did not answer within 3 s: does its callback return a response, and wait for no '
        'other answer (client.call) in the same group?'
    )
