# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of tf2_ros as processes: what they print, how they end, what they refuse."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
import re
import signal
import subprocess
import sys
import time
from typing import Any

from geometry_msgs.msg import PointStamped, TransformStamped
from playpen_testing.fast_dds import without_port_race
from playpen_testing.here import run_here
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
import tf2_geometry_msgs  # noqa: F401  # it registers what transforms points
import tf2_ros
from tf2_ros import tf2_echo

TURNED = """\
At time 0.0
- Translation: [1.000, -2.000, 0.500]
- Rotation: in Quaternion (xyzw) [0.000, 0.000, 0.707, 0.707]
- Rotation: in RPY (radian) [0.000, -0.000, 1.571]
- Rotation: in RPY (degree) [0.000, -0.000, 90.000]
- Matrix:
  0.000 -1.000  0.000  1.000
  1.000  0.000  0.000 -2.000
  0.000  0.000  1.000  0.500
  0.000  0.000  0.000  1.000
"""


def run(program: str, *arguments: str, timeout_sec: float = 30.0) -> Any:
    answer = subprocess.run(
        ['ros2', 'run', 'tf2_ros', program, *arguments],
        capture_output=True,
        text=True,
        timeout=timeout_sec,
    )
    assert 'Traceback' not in answer.stderr, answer.stderr
    answer.stdout = without_port_race(answer.stdout)
    return answer


def program(name: str) -> str:
    """Return what `ros2 run tf2_ros` would start."""
    return str(Path(sys.prefix) / 'lib' / 'tf2_ros' / name)


def publish(processes: Any, *arguments: str) -> None:
    """Start a static_transform_publisher; return once it publishes."""
    command = (program('static_transform_publisher'), *arguments)
    processes.start(*command, ready="from 'odom' to 'base'")


@pytest.mark.usefixtures('domain')
def test_packages_and_programs_have_the_names_of_jazzy(ros2_here: Any) -> None:
    known = {
        'tf2_ros',
        'tf2_ros_py',
        'tf2_py',
        'tf2_tools',
        'tf2_geometry_msgs',
        'tf2_sensor_msgs',
    }
    assert {*known, 'sensor_msgs_py'} <= {*ros2_here('pkg', 'list').lines}
    programs = ('buffer_server', 'static_transform_publisher', 'tf2_echo', 'tf2_monitor')
    assert ros2_here('pkg', 'executables', 'tf2_ros').lines == [
        f'tf2_ros {name}' for name in programs
    ]
    assert ros2_here('pkg', 'executables', 'tf2_tools').lines == ['tf2_tools view_frames']
    versions = [
        ros2_here('pkg', 'xml', name, '-t', 'version').out for name in ('tf2_ros', 'tf2_ros_py')
    ]
    assert versions[0] == versions[1]


def test_tf2_echo_prints_what_is_published_in_each_way(processes: Any, domain: int) -> None:
    place = ('--x', '1', '--y', '-2', '--z', '0.5')
    ways = (
        (*place, '--yaw', '1.5707963267948966', '--frame-id', 'odom', '--child-frame-id', 'base'),
        (*place, '--qz', '1', '--qw', '1', '--frame-id', 'odom', '--child-frame-id', 'second'),
        ('1', '-2', '0.5', '1.5707963267948966', '0', '0', 'odom', 'third'),
        ('1', '-2', '0.5', '0', '0', '1', '1', 'odom', 'fourth'),
    )
    command = (program('static_transform_publisher'),)
    for words in ways:
        processes.start(*command, *words)
    answer = run('tf2_echo', 'odom', 'base', '5', '--limit', '2')
    assert answer.returncode == 0
    assert re.sub(r'-(0\.000 )', r' \1', answer.stdout) == 2 * TURNED
    waiting = r'\[INFO\] \[\d+\.\d+\] \[tf2_echo\]: Waiting for transform odom ->  base: '
    waiting += 'Invalid frame ID "odom" passed to canTransform argument target_frame - '
    assert re.match(waiting + 'frame does not exist\n', answer.stderr)
    with SpunNodes(domain) as nodes:
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer, nodes.start(Node, 'hears'))
        for child in ('base', 'second', 'third', 'fourth'):
            wait_until(
                partial(buffer.can_transform, 'odom', child, Time()),
                timeout_sec=20.0,
                what=f'a transform from odom to {child}',
            )
            found = buffer.lookup_transform_core('odom', child, Time())
            shown = re.sub(r'-(0\.000 )', r' \1', f'{tf2_echo.describe(found, 3)}\n')
            assert shown == TURNED, child


def test_tf2_echo_has_more_digits_another_rate_and_an_end(processes: Any) -> None:
    publish(processes, '--x', '0.123456', '--frame-id', 'odom', '--child-frame-id', 'base')
    command = (program('tf2_echo'), 'odom', 'base', '-r', '20', '-p', '5')
    echo = processes.start(*command, '-l', '10', ready='At time 0.0')
    begin = time.monotonic()
    shown = echo.stdout.read()
    assert time.monotonic() - begin < 5.0, 'nine more took as long as at a rate of 1 Hz'
    assert shown.count('- Translation: [0.12346, 0.00000, 0.00000]\n') == 10
    assert ' 1.00000 0.00000 0.00000 0.12346\n' in shown
    # It ends with who reads it, without a word.
    piped = 'set -o pipefail; ros2 run tf2_ros tf2_echo odom base 20 | grep -m 1 Matrix'
    answer = subprocess.run(['bash', '-c', piped], capture_output=True, text=True, timeout=30.0)
    assert answer.stdout == '- Matrix:\n'
    assert [line for line in answer.stderr.splitlines() if '[INFO]' not in line] == []
    assert answer.returncode == 128 + signal.SIGPIPE


def test_tf2_echo_says_what_is_wrong_once_frames_part(processes: Any, domain: int) -> None:
    class Sender(Node):
        """Moves a frame to another tree."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__('sender', **arguments)
            self.broadcaster = tf2_ros.StaticTransformBroadcaster(self)
            self.send('odom')

        def send(self, parent: str) -> None:
            message = TransformStamped(child_frame_id='base')
            message.header.frame_id = parent
            tf2_ros.StaticTransformBroadcaster.__init__(self.broadcaster, self)
            self.broadcaster.sendTransform(message)

    with SpunNodes(domain) as nodes:
        sender = nodes.start(Sender)
        echo = processes.start(program('tf2_echo'), 'odom', 'base', '20', ready='At time 0.0')
        sender.send('elsewhere')
        failure = ''
        for line in echo.stdout:
            failure += line
            if 'exists with parent' in line:
                break
    assert re.search(
        r'Failure at \d+\.\d{3}\n'
        "Exception thrown:Could not find a connection between 'odom' and 'base' because they are "
        'not part of the same tree.Tf has two or more unconnected trees.\n'
        'The current list of frames is:\n'
        'Frame base exists with parent elsewhere.\n',
        failure,
    )


@pytest.mark.usefixtures('domain')
def test_tf2_echo_refuses_bad_arguments(capfd: pytest.CaptureFixture[str]) -> None:
    bad = {
        (): (1, 'the following arguments are required: source_frame, target_frame'),
        ('a', 'b', '1', 'c'): (1, 'unrecognized arguments: c'),
        ('a', 'b', 'fast'): (2, "Failed to convert rate argument 'fast' to a floating-point"),
        ('a', 'b', '1.0foo'): (3, "Failed to convert rate argument '1.0foo' to a floating-"),
        ('a', 'b', '0'): (2, "tf2_echo: rate '0' is refused: it must be more than 0"),
        ('a', 'b', '-p', '0'): (1, "'0' is refused: it must be a whole number from 1"),
    }
    for words, (status, said) in bad.items():
        each = run_here(capfd, 'tf2_ros.tf2_echo', *words)
        assert (each.status, said in each.err) == (status, True), (words, each)
        usage = 'Usage: tf2_echo source_frame target_frame'
        assert each.out.startswith(usage) == (status == 1), words
    answer = run('tf2_echo', 'a', 'b', 'fast')
    assert (answer.returncode, answer.stdout) == (2, '[ros2run]: Process exited with failure 2\n')


@pytest.mark.usefixtures('domain')
def test_static_transform_publisher_refuses_bad_arguments(
    capfd: pytest.CaptureFixture[str],
) -> None:
    bad = {
        (): 'Frame id must not be empty',
        ('--frame-id', 'a'): 'Child frame id must not be empty',
        ('--x',): 'Not enough arguments for --x',
        ('--x', 'far'): 'Failed to parse --x argument as float',
        ('1', '2', 'far', '0', '0', '0', 'a', 'b'): 'Failed to parse z argument as float',
        ('--yaw', '1', '--qw', '1'): 'Cannot specify both quaternion and Euler rotations',
        ('1', '2'): 'Extra unparsed arguments on command-line',
        ('0', '0', '0', '0', '0', '0', 'a', 'b', '--x', '1'): (
            'Cannot specify both new-style (flags) and old-style (arguments)'
        ),
    }
    module = 'tf2_ros.static_transform_publisher'
    itself = ('--frame-id', 'a', '--child-frame-id', 'a')
    for words, said in bad.items():
        each = run_here(capfd, module, *words)
        assert each.status == 1, words
        assert f'[]: error parsing command line arguments: {said}\n' in each.err, words
        assert each.out.startswith('usage: static_transform_publisher [--x X]'), words
    in_itself = run_here(capfd, module, *itself)
    assert in_itself.status == 1
    told = "[]: cannot publish static transform from 'a' to 'a', exiting\n"
    assert told in in_itself.err
    answer = run('static_transform_publisher', *itself)
    assert (answer.returncode, told in answer.stderr) == (1, True)


def test_static_transform_publisher_tells_its_transform_as_parameters(
    processes: Any, ros2_here: Any
) -> None:
    publish(processes, '--z', '3', '--frame-id', 'odom', '--child-frame-id', 'base')
    (name,) = ros2_here('node', 'list').lines
    assert re.fullmatch(r'/static_transform_publisher_[0-9A-Za-z]{16}', name)
    for parameter, value in (('translation.z', '3.0'), ('child_frame_id', 'base')):
        assert ros2_here('param', 'get', name, parameter).out.split()[-1] == value
    refused = ros2_here('param', 'set', name, 'translation.z', '4.0')
    assert 'read-only' in refused.out + refused.err


@pytest.mark.usefixtures('domain')
def test_wrong_ros_arguments_are_told_without_a_traceback(
    capfd: pytest.CaptureFixture[str],
) -> None:
    frames = ('--frame-id', 'a', '--child-frame-id', 'b')
    programs = {
        'tf2_ros.tf2_echo': ('a', 'b'),
        'tf2_ros.tf2_monitor': (),
        'tf2_ros.buffer_server': (),
        'tf2_ros.static_transform_publisher': frames,
        'tf2_tools.view_frames': (),
        'turtlesim_programs.turtlesim_node': ('--platform', 'offscreen'),
    }
    commands = [
        (module, *words, '--ros-args', *wrong)
        for module, words in programs.items()
        for wrong in (('-p', 'x'), ('--nonsense',), ('-r', '__node:=7'))
    ]
    for command in commands:
        ended = run_here(capfd, *command)
        assert ended.status == 2, (command, ended.err)
        assert 'Traceback' not in ended.err, command
        assert command[-1] in ended.err, command
    answer = run('tf2_monitor', '--ros-args', '-r', '__node:=7')
    assert (answer.returncode, '__node:=7' in answer.stderr) == (2, True), answer.stderr


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    ('words', 'ready'),
    [
        (('static_transform_publisher', '0', '0', '0', '0', '0', '0', 'a', 'b'), "from 'a' to"),
        (('tf2_echo', 'a', 'b', '0.1'), 'Waiting for transform'),
        (('tf2_monitor',), 'Gathering data on all frames for 10 seconds...'),
    ],
)
def test_a_signal_ends_a_program_soon(
    processes: Any, words: tuple[str, ...], ready: str, number: signal.Signals
) -> None:
    process = processes.start(program(words[0]), *words[1:], ready=ready)
    begin = time.monotonic()
    process.send_signal(number)
    output, _ = process.communicate(timeout=10)
    assert (output, process.returncode) == ('', 0), output
    assert time.monotonic() - begin < 2.0


@pytest.mark.timeout(60)
def test_tf2_monitor_reports_delays_and_the_chain(processes: Any, domain: int) -> None:
    class Sender(Node):
        """Sends a transform a quarter of a second late."""

        def __init__(self, **arguments: Any) -> None:
            super().__init__('sender', **arguments)
            self.broadcaster = tf2_ros.TransformBroadcaster(self)
            self.create_timer(0.1, self.send)

        def send(self) -> None:
            message = TransformStamped(child_frame_id='base')
            message.header.frame_id = 'odom'
            late = self.get_clock().now() - Duration(seconds=0.25)
            message.header.stamp = late.to_msg()
            self.broadcaster.sendTransform(message)

    publish(processes, '0', '0', '0', '0', '0', '0', 'odom', 'base')
    with SpunNodes(domain) as nodes:
        nodes.start(Sender)
        command = (program('tf2_monitor'), 'base', 'odom')
        monitor = processes.start(*command, ready='Gathering data on base -> odom for 10 seconds')
        report = ''
        for line in monitor.stdout:
            report += line
            if line.startswith('Node:'):
                break
    assert 'RESULTS: for base to odom\nChain is: base -> odom\nNet delay     avg = ' in report
    (delay,) = re.findall(
        'Frame: base, published by <no authority available>, Average Delay: ([0-9.e+]+)', report
    )
    assert float(delay) >= 0.25
    (rate,) = re.findall(r'Node: <no authority available> ([0-9.]+) Hz', report)
    assert 5.0 < float(rate) < 20.0


@pytest.mark.usefixtures('domain')
def test_tf2_monitor_wants_two_frames_or_none() -> None:
    answer = run('tf2_monitor', 'a')
    usage = 'TF_Monitor: usage: tf2_monitor framea frameb\n'
    assert (answer.returncode, answer.stdout.startswith(usage)) == (255, True)


@pytest.fixture
def client(processes: Any, domain: int) -> Iterator[tf2_ros.BufferClient]:
    processes.start(program('buffer_server'))
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'asking')
        asking = tf2_ros.BufferClient(node, 'tf2_buffer_server')
        wait_until(asking.action_client.server_is_ready, timeout_sec=10.0, what='the server')
        yield asking
    asking.destroy()


def test_a_buffer_client_gets_transforms_and_refusals(
    processes: Any, client: tf2_ros.BufferClient
) -> None:
    with pytest.raises(tf2_ros.LookupException) as caught:
        client.lookup_transform('odom', 'base', Time())
    assert str(caught.value) == (
        '"odom" passed to lookupTransform argument target_frame does not exist. '
    )
    with pytest.raises(tf2_ros.InvalidArgumentException):
        client.lookup_transform('/odom', 'base', Time())
    assert not client.can_transform('odom', 'base', Time(), Duration(seconds=0.2))
    publish(processes, '--x', '4', '--frame-id', 'odom', '--child-frame-id', 'base')
    waited = client.lookup_transform('odom', 'base', Time(), Duration(seconds=10))
    assert waited.transform.translation.x == 4.0
    asked = ('base', Time(), 'odom', Time(), 'odom')
    assert client.lookup_transform_full(*asked).transform.translation.x == -4.0
    assert client.can_transform_full(*asked)
    with pytest.raises(TypeError, match=r'^Must pass a rclpy.time.Time object.$'):
        client.lookup_transform('odom', 'base', 1.0)


def test_a_buffer_client_asks_for_the_times_that_it_is_given(
    client: tf2_ros.BufferClient,
) -> None:
    sender = tf2_ros.TransformBroadcaster(client.node)
    wait_until(
        sender.pub_tf.get_subscription_count, timeout_sec=10.0, what='the ear of the server'
    )
    moved = []
    for sec in (1, 3):
        each = TransformStamped(child_frame_id='base')
        each.header.frame_id, each.header.stamp.sec = 'odom', sec
        each.transform.translation.x = float(sec**2)
        moved.append(each)
    sender.sendTransform(moved)
    between = client.lookup_transform('odom', 'base', Time(seconds=2), Duration(seconds=10))
    assert between.transform.translation.x == 5.0
    asked = ('base', Time(seconds=1), 'base', Time(seconds=3), 'odom')
    assert client.lookup_transform_full(*asked).transform.translation.x == 8.0
    point = tf2_ros.Stamped(PointStamped(), Time(seconds=2).to_msg(), 'base')
    with pytest.warns(UserWarning, match='Passing a builtin_interfaces.msg.Time'):
        assert client.transform(point, 'odom').point.x == 5.0


def test_a_buffer_client_without_a_server_says_so(domain: int) -> None:
    with SpunNodes(domain) as nodes:
        client = tf2_ros.BufferClient(nodes.start(Node, 'asking'), 'nobody')
        with pytest.raises(tf2_ros.TimeoutException, match=r'^The BufferServer is not ready.$'):
            client.lookup_transform('odom', 'base', Time())
    client.destroy()
