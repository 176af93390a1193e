# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The `ros2` commands that courses type at a turtlesim."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
import json
from pathlib import Path
import signal
import sqlite3
from typing import Any

from ament_index_python import get_package_share_directory
from playpen_testing.here import run_here
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
from playpen_testing.waiting import wait_until
import pytest
import yaml

PEN = {'r': 0xB3, 'g': 0xB8, 'b': 0xFF}
# Made by upstream's generators from upstream's definitions, release 1.8.2; that of Color is what a
# Jazzy in the field has announced.
HASHES = {
    'action/RotateAbsolute': '08ba6dd83d976f1cb548edd1f75f16cf30cca624ce1410b6ce77f44b8a3c2895',
    'msg/Color': '74492579ec0d734707aede0e742ab76c55ac50d3ff917381e5163624cb657fe5',
    'msg/Pose': '739beba26bcba6920404ba722b7b8321348512f92ea5be235c47251940dd8aa9',
    'srv/Kill': '81c7c9131a0802f384e515fbd04867f8da57abaa83ee3a0ec76e39091e54bbc3',
    'srv/SetPen': '45ca246c7258172a89a58856037d6b4489eb46a18f1d8ee1988c018ef46fcfce',
    'srv/Spawn': 'a71be24836f772debd6187dc8618cc47700d2602c7a3e2228bad67a8f5fd27b4',
    'srv/TeleportAbsolute': '139aa0f215e25dc085067f070adb3ef65cf3c92d201f5cb750d51ca9322166b6',
    'srv/TeleportRelative': '6e9e54cb05e1a789f982bf8c93d27fc899cee099746c4ea8c7cb64e8a90297d6',
}
INTERFACES = {
    'turtlesim/action/RotateAbsolute': ['float32 theta', 'float32 delta', 'float32 remaining'],
    'turtlesim/msg/Color': ['uint8 r', 'uint8 g', 'uint8 b'],
    'turtlesim/msg/Pose': [
        *('float32 x', 'float32 y', 'float32 theta'),
        *('float32 linear_velocity', 'float32 angular_velocity'),
    ],
    'turtlesim/srv/Kill': ['string name'],
    'turtlesim/srv/SetPen': ['uint8 r', 'uint8 g', 'uint8 b', 'uint8 width', 'uint8 off'],
    'turtlesim/srv/Spawn': [
        'float32 x',
        'float32 y',
        'float32 theta',
        'string name',
        'string name',
    ],
    'turtlesim/srv/TeleportAbsolute': ['float32 x', 'float32 y', 'float32 theta'],
    'turtlesim/srv/TeleportRelative': ['float32 linear', 'float32 angular'],
}


Ros2 = Callable[..., str]


@pytest.fixture
def ros2(capfd: pytest.CaptureFixture[str]) -> Ros2:
    """Return a function that runs the command to its end and returns what it printed."""

    def run(*words: str) -> str:
        done = run_here(capfd, 'ros2cli.cli', *words)
        printed = '\n'.join((done.out + done.err).splitlines())
        assert done.status == 0, printed
        assert 'Traceback' not in printed
        return printed

    return run


def echoed(ros2: Ros2, topic: str) -> Any:
    # Lost messages are told between the others: a busy machine may lose some of 62 a second.
    shown = ros2('topic', 'echo', '--once', '--no-lost-messages', topic)
    return yaml.safe_load(shown.partition('---')[0])


def test_the_package_has_its_programs_and_interfaces(ros2: Ros2) -> None:
    programs = ('draw_square', 'mimic', 'turtle_teleop_key', 'turtlesim_node')
    assert ros2('pkg', 'executables', 'turtlesim').split('\n') == [
        f'turtlesim {program}' for program in programs
    ]
    assert Path(ros2('pkg', 'prefix', 'turtlesim').strip(), 'lib', 'turtlesim', 'mimic').is_file()
    assert ros2('pkg', 'xml', 'turtlesim', '-t', 'version').split()[-1] == '1.8.3'
    assert sorted(ros2('interface', 'package', 'turtlesim').split()) == sorted(INTERFACES)
    for name in INTERFACES:
        shown = ros2('interface', 'show', '--no-comments', name)
        lines = [line.strip() for line in shown.splitlines() if line.strip('- ')]
        assert lines == INTERFACES[name], name


def test_what_the_tutorials_list_is_listed(ros2: Ros2, turtlesim: Process) -> None:
    assert ros2('node', 'list') == '/turtlesim'
    assert ros2('topic', 'list', '-t').split('\n') == [
        '/parameter_events [rcl_interfaces/msg/ParameterEvent]',
        '/rosout [rcl_interfaces/msg/Log]',
        '/turtle1/cmd_vel [geometry_msgs/msg/Twist]',
        '/turtle1/color_sensor [turtlesim/msg/Color]',
        '/turtle1/pose [turtlesim/msg/Pose]',
    ]
    services = ros2('service', 'list').split('\n')
    assert [name for name in services if not name.startswith('/turtlesim/')] == [
        *('/clear', '/kill', '/reset', '/spawn', '/turtle1/set_pen'),
        *('/turtle1/teleport_absolute', '/turtle1/teleport_relative'),
    ]
    actions = ros2('action', 'list', '-t')
    assert actions == '/turtle1/rotate_absolute [turtlesim/action/RotateAbsolute]'
    told = ros2('node', 'info', '/turtlesim')
    assert (
        '/parameter_events: rcl_interfaces/msg/ParameterEvent' in told.partition('Publishers')[0]
    )


def test_services_are_called_as_in_the_tutorials(ros2: Ros2, turtlesim: Process) -> None:
    asked = "{x: 2, y: 2, theta: 0.2, name: ''}"
    answer = ros2('service', 'call', '/spawn', 'turtlesim/srv/Spawn', asked)
    assert "turtlesim.srv.Spawn_Response(name='turtle2')" in answer
    assert echoed(ros2, '/turtle2/pose') == pytest.approx(
        {'x': 2.0, 'y': 2.0, 'theta': 0.2, 'linear_velocity': 0.0, 'angular_velocity': 0.0}
    )
    ros2('service', 'call', '/clear', 'std_srvs/srv/Empty')
    turtlesim.wait_for_text('Clearing turtlesim.')


def test_a_published_command_moves_and_draws(ros2: Ros2, turtlesim: Process) -> None:
    def draws() -> bool:
        # Again where nothing comes of it: on a busy machine it may end before DDS has found all.
        ros2(
            *('topic', 'pub', '--once', '/turtle1/cmd_vel', 'geometry_msgs/msg/Twist'),
            '{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}',
        )
        return bool(echoed(ros2, '/turtle1/color_sensor') == PEN)

    wait_until(draws, timeout_sec=30.0, what='the colour of the pen')


def test_a_goal_is_sent_with_feedback(ros2: Ros2, turtlesim: Process) -> None:
    told = ros2(
        *('action', 'send_goal', '/turtle1/rotate_absolute', 'turtlesim/action/RotateAbsolute'),
        *('{theta: 1.57}', '--feedback'),
    )
    assert told.count('remaining: ') > 50
    assert float(told.partition('delta: ')[2].split()[0]) == pytest.approx(-1.57, abs=0.021)
    assert 'Goal finished with status: SUCCEEDED' in told


@pytest.mark.usefixtures('default_parameters')
def test_parameters_are_set_dumped_and_loaded(
    ros2: Ros2, turtlesim: Process, tmp_path: Path
) -> None:
    assert ros2('param', 'get', '/turtlesim', 'background_g') == 'Integer value is: 86'
    assert ros2('param', 'set', '/turtlesim', 'background_r', '150') == 'Set parameter successful'
    dumped = ros2('param', 'dump', '/turtlesim')
    parameters = yaml.safe_load(dumped)['/turtlesim']['ros__parameters']
    wanted = {'background_r': 150, 'background_g': 86, 'background_b': 255, 'holonomic': False}
    assert wanted.items() <= parameters.items()
    file = tmp_path / 'turtlesim.yaml'
    file.write_text(dumped.replace('background_b: 255', 'background_b: 7'))
    ros2('param', 'load', '/turtlesim', str(file))
    assert ros2('param', 'get', '/turtlesim', 'background_b') == 'Integer value is: 7'


def test_a_recorded_drive_is_played_again(
    ros2: Ros2, processes: Processes, student: TurtleClient, tmp_path: Path
) -> None:
    student.command('turtle1')  # it is recorded once somebody publishes it
    bag = tmp_path / 'bag'
    options = ('-s', 'sqlite3', '-o', str(bag))  # others can read it while it is written
    recorder = processes.start('ros2', 'bag', 'record', *options, '/turtle1/cmd_vel')
    recorder.wait_for_text('Recording...')
    student.wait_for(
        lambda: student.node.count_subscribers('/turtle1/cmd_vel') == 2, 'the recorder'
    )
    student.pose()
    student.command('turtle1', x=1.0)
    gone = student.wait_for_pose(lambda pose: pose.x > 6.0, 'a turtle that goes')
    with closing(sqlite3.connect(f'file:{bag / "bag_0.db3"}?mode=ro', uri=True)) as written:
        count = written.cursor().execute
        student.wait_for(
            lambda: count('SELECT COUNT(*) FROM messages').fetchone() == (1,), 'its record'
        )
    recorder.signal(signal.SIGINT)
    recorder.wait()
    ros2('bag', 'play', str(bag))
    student.wait_for_pose(lambda pose: pose.x > gone.x + 0.6, 'a turtle that goes again')


def test_hashes_are_those_of_jazzy() -> None:
    share = Path(get_package_share_directory('turtlesim'))
    for name, type_hash in HASHES.items():
        described = json.loads((share / f'{name}.json').read_text())
        assert {
            'type_name': f'turtlesim/{name}',
            'hash_string': f'RIHS01_{type_hash}',
        } in described['type_hashes']
