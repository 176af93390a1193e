# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A workspace with interfaces of its own, built by colcon and used across processes."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
import os
from pathlib import Path
from random import Random
import shutil
import signal
import subprocess
from typing import Any

from husky_sim.messages.cdr import decode, encode
from playpen_testing.random_messages import random_message
import pytest
import rclpy
from rclpy.serialization import deserialize_message, serialize_message

WORKSPACE = Path(__file__).resolve().parent.parent / 'workspace'
SPHERE_HASH = 'RIHS01_df3d7dcce529c7e935610cfd7d44e5fd03cedd44163fd7e01b7f62d5cc21cd1b'
SOURCED = 'source install/setup.bash && env -0'


@pytest.fixture(scope='module')
def workspace(shared_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Build the workspace, and put this process and its children into its environment."""
    folder = tmp_path_factory.mktemp('workspace')
    shutil.copytree(WORKSPACE, folder / 'src')
    (folder / 'random.py').write_text('raise SystemExit(3)')  # a student's own
    built = subprocess.run(['colcon', 'build'], cwd=folder, capture_output=True, text=True)
    assert built.returncode == 0, built.stdout + built.stderr
    environment = subprocess.run(
        ['bash', '-c', SOURCED], cwd=folder, check=True, capture_output=True, text=True
    ).stdout
    with pytest.MonkeyPatch.context() as monkeypatch:
        for name, _, value in (line.partition('=') for line in environment.split('\0')):
            if name in ('AMENT_PREFIX_PATH', 'PYTHONPATH'):
                monkeypatch.setenv(name, value)
        for path in os.environ['PYTHONPATH'].split(os.pathsep):
            monkeypatch.syspath_prepend(path)
        yield folder


@pytest.fixture(scope='module')
def shapes(workspace: Path, shared_processes: Any) -> None:
    """Start the node of the workspace that publishes, serves and acts."""
    shared_processes.ros2('run', 'shape_nodes', 'shapes', ready='ready')


def test_colcon_test_tells_of_the_tests_that_are_left_out(tmp_path: Path) -> None:
    package = tmp_path / 'src' / 'only_files'
    shutil.copytree(WORKSPACE / 'only_files', package)
    test = 'if(BUILD_TESTING)\n  ament_add_pytest_test(mine test/test_mine.py)\nendif()\n'
    lists = package / 'CMakeLists.txt'
    lists.write_text(f'{test}{lists.read_text()}')
    tested = subprocess.run(['colcon', 'test'], cwd=tmp_path, capture_output=True, text=True)
    assert tested.returncode == 0, tested.stdout
    assert 'only_files: CMakeLists.txt:2: ament_add_pytest_test(mine): is not run' in tested.stderr


def test_a_message_crosses_processes_with_all_that_is_in_it(shapes: None) -> None:
    Nested = import_module('every_kind_msgs.msg').Nested
    heard: list[Any] = []
    rclpy.init()
    try:
        node = rclpy.create_node('listener')
        node.create_subscription(Nested, 'everything', heard.append, 10)
        for _ in range(100):
            if heard:
                break
            rclpy.spin_once(node, timeout_sec=0.1)
    finally:
        rclpy.shutdown()
    assert heard, 'nothing came on /everything'
    assert (heard[0].last, heard[0].spheres[0].radius, heard[0].texts[0].text) == (9, 2.5, 'ä€')
    assert heard[0].numbers == import_module('every_kind_msgs.msg').Numbers()


@pytest.mark.parametrize(
    'name',
    [
        *('msg.Numbers', 'msg.Texts', 'msg.Nested', 'msg.Nothing', 'msg.FromIdl'),
        *('srv.Lists_Request', 'srv.Lists_Response'),
    ],
)
def test_an_independent_reader_reads_every_kind_of_field(workspace: Path, name: str) -> None:
    folder, _, kind_name = name.partition('.')
    kind = getattr(import_module(f'every_kind_msgs.{folder}'), kind_name)
    random = Random(name)
    for _ in range(50):
        message = random_message(kind, random)
        data = bytes(serialize_message(message))
        assert data == encode(message)
        assert decode(kind, data) == message == deserialize_message(data, kind)


def test_defaults_and_constants_are_those_of_the_definition(workspace: Path) -> None:
    module = import_module('every_kind_msgs.msg')
    numbers = module.Numbers
    assert (numbers.ANSWER, numbers.LARGEST, numbers.SMALLEST) == (42, 2**64 - 1, -128)
    assert (numbers.HALF, numbers.YES, numbers.GREETING) == (0.5, True, "hello, it's me")
    assert numbers().exact == -1.5e300
    assert numbers().flags == [True, False, True]
    assert list(numbers().ports) == [1, 2]
    assert module.Texts().text == 'default "quoted"'
    assert module.FromIdl().number == 5
    assert module.FromIdl.LIMIT == 7


def test_interface_show_prints_own_definitions(workspace: Path, ros2: Any) -> None:
    shown = ros2('interface', 'show', 'tutorial_interfaces/msg/Sphere').lines
    assert shown[:2] == ['geometry_msgs/Point center', '\tfloat64 x']
    assert 'float64 radius  # [m]' in shown
    listed = ros2('interface', 'package', 'tutorial_interfaces').lines
    assert 'tutorial_interfaces/action/Fibonacci' in listed
    assert ros2('interface', 'proto', 'tutorial_interfaces/msg/Num').out == '"num: 0\n"\n'


def test_topic_commands_know_an_own_type(shapes: None, ros2: Any) -> None:
    echoed = ros2('topic', 'echo', '--once', '/sphere').lines
    assert echoed[:5] == ['center:', '  x: 0.0', '  y: 0.0', '  z: 0.0', 'radius: 2.5']
    told = ros2('topic', 'info', '-v', '/sphere').out
    # as an installation of Jazzy with the C++ type supports tells it
    assert 'Topic type: tutorial_interfaces/msg/Sphere' in told
    assert SPHERE_HASH in told


def test_topic_pub_sends_an_own_type(shapes: None, ros2: Any, shared_processes: Any) -> None:
    words = ('topic', 'pub', '-r', '10', '/num', 'tutorial_interfaces/Num', '{num: 7}')
    publisher = shared_processes.ros2(*words)
    echoed = ros2('topic', 'echo', '--once', '/num', 'tutorial_interfaces/msg/Num').lines
    publisher.terminate()
    assert echoed[0] == 'num: 7'


def test_service_call_asks_an_own_service(shapes: None, ros2: Any) -> None:
    words = ('/add_three_ints', 'tutorial_interfaces/srv/AddThreeInts', '{a: 1, b: 2, c: -39}')
    assert 'AddThreeInts_Response(sum=-36)' in ros2('service', 'call', *words).out


def test_service_echo_shows_requests_and_answers(shapes: None, shared_processes: Any) -> None:
    words = ('/add_three_ints', 'tutorial_interfaces/srv/AddThreeInts', '{a: 1, c: -39}')
    calls = shared_processes.ros2('service', 'call', '-r', '5', *words)
    echo = shared_processes.ros2('service', 'echo', '/add_three_ints', ready='c: -39')
    assert any('sum: -38' in line for line in echo.stdout), 'no answer is shown'
    calls.terminate()
    echo.terminate()


def test_a_node_describes_its_own_types(shapes: None, ros2: Any) -> None:
    request = (
        f'{{type_name: tutorial_interfaces/msg/Sphere, type_hash: {SPHERE_HASH}, '
        'include_type_sources: true}'
    )
    kind = 'type_description_interfaces/srv/GetTypeDescription'
    told = ros2('service', 'call', '/shapes/get_type_description', kind, request).out
    assert 'successful=True' in told
    assert "name='radius'" in told
    assert 'float64 radius  # [m]' in told, 'not the source'


def test_action_send_goal_carries_out_an_own_action(shapes: None, ros2: Any) -> None:
    words = ('/fibonacci', 'tutorial_interfaces/action/Fibonacci', '{order: 9}')
    out = ros2('action', 'send_goal', '--feedback', *words).out
    assert (
        'Feedback:\n    partial_sequence:\n' in out
    )  # the first may come before the goal's answer
    assert '- 0\n- 1\n- 1\n- 2\n- 3\n' in out.partition('Result:')[2]
    assert 'SUCCEEDED' in out


def test_a_bag_plays_own_messages(
    shapes: None, shared_processes: Any, ros2: Any, tmp_path: Path
) -> None:
    bag = str(tmp_path / 'bag')
    words = ('bag', 'record', '-o', bag, '/sphere')
    recorder = shared_processes.ros2(*words, ready="Subscribed to topic '/sphere'")
    ros2('topic', 'echo', '--once', '/sphere')
    recorder.send_signal(signal.SIGINT)
    rest, _ = recorder.communicate(timeout=10)
    assert 'Recording stopped' in rest, rest
    player = shared_processes.ros2('bag', 'play', '--loop', bag, '--remap', '/sphere:=/played')
    echoed = ros2('topic', 'echo', '--once', '/played', 'tutorial_interfaces/msg/Sphere').lines
    player.terminate()
    assert 'radius: 2.5' in echoed


def test_files_alone_are_installed(workspace: Path, ros2: Any) -> None:
    share = workspace / 'install' / 'only_files' / 'share' / 'only_files'
    assert sorted(path.name for path in (share / 'launch').iterdir()) == ['hello.launch.yaml']
    assert ros2('run', 'only_files', 'hello_there').out == 'hello from only_files\n'


def test_a_second_build_makes_only_what_has_changed(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = workspace / 'install' / 'tutorial_interfaces'
    module = next(installed.rglob('_num.py'))
    other = next(installed.rglob('_sphere.py'))
    before = module.stat().st_mtime_ns
    build = ['colcon', 'build', '--packages-select', 'tutorial_interfaces']
    subprocess.run(build, cwd=workspace, check=True, capture_output=True)
    assert module.stat().st_mtime_ns == before
    definition = workspace / 'src' / 'tutorial_interfaces' / 'msg' / 'Num.msg'
    definition.write_text('int64 num\nstring unit\n')
    subprocess.run(build, cwd=workspace, check=True, capture_output=True)
    assert 'unit' in module.read_text()
    definition.write_text('int64 num\nstrin unit\n')
    failed = subprocess.run(build, cwd=workspace, capture_output=True, text=True)
    assert failed.returncode != 0
    assert "msg/Num.msg:2: 'strin' is no type: did you mean string?" in failed.stderr
    assert 'Traceback' not in failed.stderr
    assert other.is_file(), 'what was installed before is gone'
    assert 'unit' in module.read_text(), 'what was installed before is gone'


def test_two_definitions_of_one_type_are_told_of(workspace: Path, shared_processes: Any) -> None:
    words = ('topic', 'pub', '-r', '10', '/length', 'tutorial_interfaces/Num', '{num: 7}')
    shared_processes.ros2(*words, ready='publishing')
    definition = workspace / 'src' / 'tutorial_interfaces' / 'msg' / 'Num.msg'
    definition.write_text('int64 num\nfloat64[4] more\n')
    build = ['colcon', 'build', '--packages-select', 'tutorial_interfaces']
    subprocess.run(build, cwd=workspace, check=True, capture_output=True)
    hint = 'have different definitions of tutorial_interfaces/msg/Num, so that what arrives is wr'
    shared_processes.ros2('topic', 'echo', '/length', ready=f'a `ros2` command {hint}')
