# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Code in the manner of ROS's own tutorials, in a workspace: built, launched, driven."""

from collections.abc import Callable
import math
import os
from pathlib import Path
import shutil
import subprocess

from playpen_testing.processes import Process, Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from turtlesim.msg import Pose

WORKSPACE = Path(__file__).resolve().parent / 'tutorials'
SOURCED = 'source install/local_setup.bash && env -0'
FORWARD = '{linear: {x: 2.0}, angular: {z: 1.0}}'

Ros2 = Callable[..., Process]
Where = Callable[[str], Pose]


@pytest.fixture(scope='module')
def workspace(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Build the workspace; return the environment of a terminal in which it is sourced."""
    folder = tmp_path_factory.mktemp('tutorials')
    shutil.copytree(WORKSPACE, folder / 'src', ignore=shutil.ignore_patterns('COLCON_IGNORE'))
    built = subprocess.run(['colcon', 'build'], cwd=folder, capture_output=True, text=True)
    assert built.returncode == 0, built.stdout + built.stderr
    told = subprocess.run(
        ['bash', '-c', SOURCED], cwd=folder, check=True, capture_output=True, text=True
    ).stdout
    return dict(entry.split('=', 1) for entry in told.split('\0') if entry)


@pytest.fixture
def ros2(workspace: dict[str, str], processes: Processes, domain_id: int) -> Ros2:
    """Run `ros2` in that terminal, with turtles that nobody sees."""
    here = {name: os.environ[name] for name in os.environ if name.startswith(('ROS_', 'FAST'))}
    environment = {**workspace, **here, 'QT_QPA_PLATFORM': 'offscreen', 'USER': 'student'}
    assert here['ROS_DOMAIN_ID'] == str(domain_id)
    return lambda *words: processes.start('ros2', *words, environment=environment)


@pytest.fixture
def where(nodes: SpunNodes) -> Where:
    """Tell where a turtle is now; fails when it says nothing within 20 s."""
    node = nodes.start(Node, 'observer')
    heard: dict[str, Pose] = {}

    def pose_of(turtle: str) -> Pose:
        if turtle not in heard:
            node.create_subscription(
                Pose, f'{turtle}/pose', lambda pose: heard.update({turtle: pose}), 1
            )
            wait_until(lambda: turtle in heard, timeout_sec=20.0, what=f'a pose of {turtle}')
        return heard[turtle]

    return pose_of


def distance(one: Pose, other: Pose) -> float:
    return math.dist((one.x, one.y), (other.x, other.y))


@pytest.mark.timeout(90)
def test_a_turtle_follows_the_frame_of_another(ros2: Ros2, where: Where) -> None:
    launch = ros2('launch', 'turtle_frames', 'chase.launch.py')
    assert distance(where('/turtle2'), where('/turtle1')) > 1.0
    wait_until(
        lambda: distance(where('/turtle2'), where('/turtle1')) < 0.3,
        timeout_sec=30.0,
        what=lambda: f'turtle2 beside turtle1; the launch says\n{launch.output}',
    )
    before = where('/turtle1')
    driver = ros2(
        'topic', 'pub', '-r', '5', '/turtle1/cmd_vel', 'geometry_msgs/msg/Twist', FORWARD
    )
    wait_until(
        lambda: distance(where('/turtle1'), before) > 1.0,
        timeout_sec=30.0,
        what=lambda: f'turtle1 driving; the command says\n{driver.output}',
    )
    driver.close()
    wait_until(
        lambda: distance(where('/turtle2'), where('/turtle1')) < 0.3,
        timeout_sec=30.0,
        what=lambda: f'turtle2 beside turtle1 again; the launch says\n{launch.output}',
    )
    echo = ros2('run', 'tf2_ros', 'tf2_echo', 'turtle2', 'turtle1')
    echo.wait_for_text('- Translation: [')


@pytest.mark.timeout(90)
def test_a_turtle_goes_to_a_carrot_that_hangs_at_another(ros2: Ros2, where: Where) -> None:
    launch = ros2('launch', 'turtle_frames', 'carrot.launch.py')
    wait_until(
        lambda: (
            abs(distance(where('/turtle2'), where('/turtle1')) - 2.0) < 0.1
            and where('/turtle2').x > where('/turtle1').x + 1.9
        ),
        timeout_sec=40.0,
        what=lambda: f'turtle2 2 m ahead of turtle1; the launch says\n{launch.output}',
    )
    echo = ros2('run', 'tf2_ros', 'tf2_echo', 'turtle1', 'carrot')
    echo.wait_for_text('- Translation: [2.000, 0.000, 0.000]')


@pytest.mark.timeout(60)
def test_what_stands_is_told_to_who_comes_late(ros2: Ros2) -> None:
    standing = ros2('run', 'turtle_frames', 'standing', 'tree', '1', '2', '0.5')
    publisher = ros2(
        *('run', 'tf2_ros', 'static_transform_publisher', '--x', '0.1', '--yaw', '1.57'),
        *('--frame-id', 'tree', '--child-frame-id', 'nest'),
    )
    echo = ros2('run', 'tf2_ros', 'tf2_echo', 'world', 'nest')
    echo.wait_for_text('- Translation: [1.100, 2.000, 0.500]')
    echo.wait_for_text('- Rotation: in RPY (radian) [0.000, -0.000, 1.570]')
    assert (standing.returncode, publisher.returncode) == (None, None)


@pytest.mark.timeout(60)
def test_changes_of_parameters_are_heard_of_two_nodes(ros2: Ros2, where: Where) -> None:
    ros2('run', 'turtlesim', 'turtlesim_node')
    watcher = ros2('run', 'turtle_frames', 'watcher')
    where('/turtle1')
    for node, name, value in (('/watcher', 'count', '43'), ('/turtlesim', 'background_r', '150')):
        wait_until(
            lambda: ros2('param', 'get', node, name).wait() == 0,  # noqa: B023
            timeout_sec=20.0,
            what=f'the parameter {name} of {node}',
        )
        assert ros2('param', 'set', node, name, value).wait() == 0
        watcher.wait_for_text(f'{name} is {value} now')


@pytest.mark.timeout(90)
@pytest.mark.parametrize('kind', ['xml', 'yaml'])
def test_a_turtle_mimics_one_of_another_namespace(ros2: Ros2, where: Where, kind: str) -> None:
    launch = ros2('launch', 'turtle_frames', f'mimic.launch.{kind}', 'background:=90')
    begun = where('/second/turtle1')
    where('/first/turtle1')
    topic = '/first/turtle1/cmd_vel'
    ros2('topic', 'pub', '-r', '2', topic, 'geometry_msgs/msg/Twist', FORWARD)
    wait_until(
        lambda: distance(where('/second/turtle1'), begun) > 0.5,
        timeout_sec=30.0,
        what=lambda: f'the turtle of second driving; the launch says\n{launch.output}',
    )
    asked = ros2('param', 'get', '/second/sim', 'background_r')
    assert asked.wait() == 0, asked.output
    assert asked.output.endswith('Integer value is: 90')


@pytest.mark.timeout(60)
def test_events_of_a_launch_come_in_their_order(ros2: Ros2) -> None:
    launch = ros2('launch', 'turtle_frames', 'events.launch.py', 'red:=255')
    launch.wait(timeout_sec=40.0)
    told = (
        *('that is very red', 'started', 'spawning says: ', "turtlesim.srv.Spawn_Response(name='"),
        *('spawned', 'Set parameter successful', 'student has set it', 'all ends: '),
    )
    places = [
        next((n for n, line in enumerate(launch.lines) if word in line), -1) for word in told
    ]
    assert -1 not in places, launch.output
    assert places == sorted(places), launch.output
    assert 'the turtle is red' in launch.lines[places[-1]]
