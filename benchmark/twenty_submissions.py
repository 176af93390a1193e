# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Twenty workspaces as students hand them in, good, slow, broken and hostile, and their rubric."""

from pathlib import Path

RUBRIC = """
title: Twenty submissions
steps:
  - {kind: package, points: 10, package: driver, dependencies: [rclpy]}
  - {kind: build, points: 10, needs_one_of: [publisher, subscriber, drive]}
  - kind: publisher
    points: 20
    package: driver
    executable: publisher
    topic: topic_test
    type: std_msgs/msg/String
    rate_hz: 10
    content:
      - {field: data, form: hello world <number>}
  - kind: subscriber
    points: 20
    package: driver
    executable: subscriber
    topic: topic_test
    type: std_msgs/msg/String
    sent: {data: 'hello grader {token}'}
    printed: heard<text>hello grader {token}
  - kind: drive
    points: 40
    package: driver
    executable: follow_path
    courses: [{file: course.yaml}]
"""
COURSE = 'speed: 0.5\nwaypoints: [[0, 0], [0.6, -0.3], [1.2, 0]]\n'

_MANIFEST = """<package><name>driver</name><exec_depend>rclpy</exec_depend>
<export><build_type>ament_python</build_type></export></package>
"""
_SETUP = """
from setuptools import setup
setup(name='driver', version='0.1.0', packages=[], data_files=[
    ('share/ament_index/resource_index/packages', ['resource/driver']),
    ('share/driver', ['package.xml']),
    ('lib/driver', ['publisher', 'subscriber', 'follow_path'])])
"""
_NODE = """#!/usr/bin/env python3
import math, os, signal, sys, time
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Int32, String
rclpy.init()
node = Node('student')
"""
_TALK = """
publisher = node.create_publisher({kind}, '{topic}', 10)
def talk():
    publisher.publish({message})
"""
_TIMER = 'node.create_timer({period}, talk)\nrclpy.spin(node)\n'
_LISTEN = """
node.create_subscription(String, 'topic_test', lambda m: node.get_logger().info({shown}), 10)
rclpy.spin(node)
"""
_DRIVE = """
commands = node.create_publisher(Twist, 'husky_velocity_controller/cmd_vel', 10)
ahead = [(0.6, -0.3), (1.2, 0.0)]
command = Twist()
def decide(odometry):
    place, q = odometry.pose.pose.position, odometry.pose.pose.orientation
    if ahead and math.dist((place.x, place.y), ahead[0]) < 0.1:
        ahead.pop(0)
    command.linear.x = command.angular.z = 0.0
    if ahead:
        left = math.atan2(ahead[0][1] - place.y, ahead[0][0] - place.x)
        left = math.remainder(left - 2.0 * math.atan2(q.z, q.w), math.tau)
        command.angular.z = max(-1.0, min(1.0, 2.0 * left))
        command.linear.x = 0.5 * max(0.0, math.cos(left))
def send():
    commands.publish(command)
    if not ahead:
        raise SystemExit
def on_odometry(odometry):
    {first}
    decide(odometry)
    {then}
node.create_subscription(Odometry, '{topic}', on_odometry, 10)
{more}
rclpy.spin(node)
"""


def talker(
    message: str = "String(data='hello world 1')",
    *,
    topic: str = 'topic_test',
    kind: str = 'String',
    period: float = 0.1,
) -> str:
    talk = _TALK.format(kind=kind, topic=topic, message=message)
    return _NODE + talk + _TIMER.format(period=period)


def listener(shown: str = "f'heard {m.data}'") -> str:
    return _NODE + _LISTEN.format(shown=shown)


def driver(
    first: str = 'pass', *, then: str = 'send()', topic: str = 'odometry/filtered', more: str = ''
) -> str:
    return _NODE + _DRIVE.format(first=first, then=then, topic=topic, more=more)


SLEEPS = _NODE + _TALK.format(
    kind='String', topic='topic_test', message="String(data='hello world 1')"
)
SLEEPS += 'while True:\n    talk()\n    time.sleep(0.1)\n'
BY_TIMER = driver(then='pass', more='node.create_timer(0.1, send)')
TOO_FAST = driver(then='command.linear.x *= 2', more='node.create_timer(0.2, send)')
HALF_WAY = 'odometry.pose.pose.position.x > 0.6'

# Of each the three programs: publisher, subscriber, follow_path.
SUBMISSIONS = {
    'good': (talker(), listener(), driver()),
    'good_slow': (SLEEPS, listener(), driver('time.sleep(0.01)')),
    'good_hardly': (talker(period=0.105), listener(), driver('sum(range(200_000))')),
    'timer_driven': (talker(), listener(), BY_TIMER),
    'half_the_rate': (talker(period=0.2), listener(), driver()),
    'twice_the_rate': (talker(period=0.05), listener(), driver()),
    'other_topic': (talker(topic='topic_text'), listener(), driver(topic='odometry/filterd')),
    'other_type': (talker('Int32(data=1)', kind='Int32'), listener('m.data'), driver()),
    'other_text': (talker("String(data='hello')"), listener("'heard it'"), driver()),
    'syntax': (talker(), 'def main(:\n', driver()),
    'crashes': (
        _NODE + "raise RuntimeError('no')\n",
        listener(),
        driver(f'if {HALF_WAY}: 1 / 0'),
    ),
    'hangs': (talker(), listener(), driver(f'if {HALF_WAY}: time.sleep(1e6)')),
    'stops_short': (talker(), listener(), driver(f'if {HALF_WAY}: ahead.clear()')),
    'timer_poor': (talker(), listener(), TOO_FAST),
    'no_number': (talker(), listener(), driver(then='command.linear.x = math.nan; send()')),
    'deaf': (talker(), _NODE + 'rclpy.spin(node)\n', driver()),
    'forges_odometry': (
        talker(),
        listener(),
        driver(more="node.create_publisher(Odometry, 'odometry/filtered', 10)"),
    ),
    'two_drivers': (
        talker(),
        listener(),
        driver(more='').replace('rclpy.init', 'os.fork(); rclpy.init'),
    ),
    'kills': (talker(), listener(), driver('os.kill(-1, signal.SIGKILL)', then='pass')),
    'copies': (
        'from topic_demo.publisher import main\nmain()\n',
        'from topic_demo.subscriber import main\nmain()\n',
        'from husky_driver.follow_path import main\nmain()\n',
    ),
}


def hand_in(folder: Path) -> None:
    """Write a workspace for each into a folder."""
    for name, programs in SUBMISSIONS.items():
        package = folder / name / 'src' / 'driver'
        (package / 'resource').mkdir(parents=True)
        (package / 'resource' / 'driver').touch()
        (package / 'package.xml').write_text(_MANIFEST)
        (package / 'setup.py').write_text(_SETUP)
        for file, text in zip(('publisher', 'subscriber', 'follow_path'), programs, strict=True):
            shebang = '' if text.startswith('#!') else '#!/usr/bin/env python3\n'
            (package / file).write_text(shebang + text)
            (package / file).chmod(0o755)
