# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A student's build and nodes in a jail, and a trusted node beside it."""

import os
from pathlib import Path
import shutil
import subprocess
import sys

from husky_grader.jail import find_sandbox, Jail, Sandbox
from playpen_testing.jails import in_each_sandbox
from playpen_testing.waiting import wait_until
import pytest

SOURCE = Path(__file__).resolve().parents[2]
MESSAGES = 300
ANSWERS = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('answers')
publisher = node.create_publisher(String, 'answers', 10)
node.create_subscription(String, 'questions', publisher.publish, 10)
rclpy.spin(node)
"""
# The next question is asked when the last one is answered, as in lockstep.
ASKS = """
import sys, time, rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node('asks')
publisher = node.create_publisher(String, 'questions', 10)
answers = []
node.create_subscription(String, 'answers', answers.append, 10)
deadline = time.monotonic() + 20.0
def spin_until(fact):
    while not fact() and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=0.1)
spin_until(lambda: publisher.get_subscription_count() and node.count_publishers('answers'))
for number in range(int(sys.argv[1])):
    publisher.publish(String(data=str(number)))
    spin_until(lambda: len(answers) > number)
print(len(answers), 'answers')
"""


@in_each_sandbox
def test_no_message_is_lost_between_a_jail_and_beside_it(
    sandbox: Sandbox, tmp_path: Path, courses: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('FASTRTPS_DEFAULT_PROFILES_FILE', str(courses.parent / 'fastdds.xml'))
    folder, log = tmp_path / 'jail', tmp_path / 'log'
    folder.mkdir()
    with Jail(sandbox, folder) as jail:
        jail.start([sys.executable, '-c', ANSWERS], log=log)
        asks = subprocess.run(
            jail.beside([sys.executable, '-c', ASKS, str(MESSAGES)]),
            env={**os.environ, **jail.graph, 'ROS_LOG_DIR': str(tmp_path)},
            capture_output=True,
            text=True,
        )
    assert asks.stdout == f'{MESSAGES} answers\n', asks.stderr + log.read_text()


@pytest.mark.timeout(180)
def test_a_workspace_is_built_and_its_programs_run(tmp_path: Path) -> None:
    sandbox = find_sandbox('kernel')  # lab gradings do it in the one that auto finds
    folder, log = tmp_path / 'jail', tmp_path / 'log'
    ignore = shutil.ignore_patterns('test', '__pycache__', '*.egg-info')
    shutil.copytree(SOURCE / 'topic_demo', folder / 'src' / 'topic_demo', ignore=ignore)
    run = 'source install/local_setup.bash; exec ros2 run topic_demo publisher'
    with Jail(sandbox, folder) as jail:
        assert jail.run(['colcon', 'build'], log=log, within_sec=120.0) == 0, log.read_text()
        jail.start(['bash', '-c', run], log=log)
        wait_until(lambda: 'hello world' in log.read_text(), timeout_sec=30.0, what=log.read_text)
