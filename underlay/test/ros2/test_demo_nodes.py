# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The programs of demo_nodes_py and action_tutorials_py: what they print, and how they end."""

from __future__ import annotations

from pathlib import Path
import re
import signal
import subprocess
import sys
from typing import Any

from example_interfaces.srv import AddTwoInts
from playpen_testing.fast_dds import without_port_race
from playpen_testing.here import run_here
from playpen_testing.processes import find_line
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

LIB = Path(sys.prefix) / 'lib'
OF_UPSTREAM = (
    *('add_two_ints_client', 'add_two_ints_client_async', 'add_two_ints_server'),
    *('async_param_client', 'introspection', 'listener', 'listener_qos', 'listener_serialized'),
    *('matched_event_detect', 'set_parameters_callback', 'talker', 'talker_qos'),
    'use_logger_service',
)
BOARD = 'parameter_blackboard'
_STAMP = re.compile(r'^\[(\w+)\] \[\d+\.\d+\] ', re.MULTILINE)


def program(name: str) -> str:
    package = 'action_tutorials_py' if name.startswith('fibonacci') else 'demo_nodes_py'
    return str(LIB / package / name)


def lines_of(output: str) -> list[str]:
    """Return what was printed, without the times."""
    return _STAMP.sub(r'[\1] ', output).splitlines()


def run(name: str, *arguments: str) -> Any:
    """Run a program that ends by itself."""
    done = subprocess.run(
        [program(name), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=30,
    )
    assert 'Traceback' not in done.stdout, done.stdout
    done.stdout = without_port_race(done.stdout)
    return done


def wait_for_node(domain: int, name: str) -> None:
    with SpunNodes(domain) as nodes:
        student = nodes.start(Node, 'student')
        wait_until(
            lambda: name in student.get_node_names(),
            timeout_sec=10,
            what=lambda: f'{name} in {student.get_node_names()}',
        )


def end(process: subprocess.Popen[str], number: int = signal.SIGINT) -> None:
    process.send_signal(number)
    output, _ = process.communicate(timeout=10)
    assert process.returncode == 0, output
    assert 'Traceback' not in output, output


@pytest.mark.usefixtures('domain')
def test_packages_have_the_programs_of_jazzy(ros2_here: Any) -> None:
    there = {line.split()[1] for line in ros2_here('pkg', 'executables', 'demo_nodes_py').lines}
    assert there == set(OF_UPSTREAM)
    assert ros2_here('pkg', 'executables', 'action_tutorials_py').lines == [
        'action_tutorials_py fibonacci_action_client',
        'action_tutorials_py fibonacci_action_server',
    ]


def test_talker_is_heard_as_text_and_as_bytes(processes: Any) -> None:
    bytes_heard = processes.start(program('listener_serialized'))
    heard = processes.start(program('listener'))
    talker = processes.start('ros2', 'run', 'demo_nodes_py', 'talker')
    said = find_line(talker.stdout, r'\[INFO\] \[\d+\.\d+\] \[talker\]: Publishing: "(.*)"$')
    assert said[1] == 'Hello World: 0'
    text = find_line(heard.stdout, r'\[INFO\] \[\d+\.\d+\] \[listener\]: I heard: \[(.*)\]$')
    assert re.fullmatch(r'Hello World: \d', text[1])
    raw = find_line(bytes_heard.stdout, r'\[serialized_subscriber\]: I heard: "(.*)"$')
    assert re.fullmatch(r"b'\\x00\\x01.*\\x0f\\x00\\x00\\x00Hello World: \d\\x00.*'", raw[1])
    end(talker)
    end(heard, signal.SIGTERM)
    end(bytes_heard)


def test_a_launch_file_starts_and_remaps_a_talker(processes: Any, tmp_path: Path) -> None:
    file = tmp_path / 'talk.launch.py'
    file.write_text("""\
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package='demo_nodes_py', executable='talker', remappings=[('chatter', 'news')]),
        Node(package='demo_nodes_py', executable='listener', remappings=[('chatter', 'news')]),
    ])
""")
    launch = processes.ros2('launch', str(file))
    find_line(launch.stdout, r'\[listener-2\] \[INFO\].*\[listener\]: I heard: \[Hello World: ')


def test_launch_files_that_pages_use_start_those_in_python(
    domain: int, capfd: pytest.CaptureFixture[str]
) -> None:
    talk = [('demo_nodes_py', 'talker'), ('demo_nodes_py', 'listener')]
    files = {f'talker_listener_launch.{suffix}': talk for suffix in ('py', 'xml', 'yaml')}
    files['introspect_services_launch.py'] = [('demo_nodes_py', 'introspection')]
    for file in files:
        printed = run_here(capfd, 'ros2cli.cli', 'launch', 'demo_nodes_cpp', file, '-p')
        started = re.findall(r"ExecInPkg\(pkg='(\w+)', exec='(\w+)'\)", printed.out)
        assert started == files[file], (file, printed.err)


def test_each_quality_of_service_has_as_many_messages_as_asked(processes: Any) -> None:
    heard = processes.start(program('listener_qos'), '-n', '1', ready='Best effort listener')
    talk = run('talker_qos', '--number_of_cycles', '2')
    assert talk.returncode == 0
    assert lines_of(talk.stdout) == [
        '[INFO] [talker_qos]: Best effort talker',
        '[INFO] [talker_qos]: Publishing: "Hello World: 0"',
        '[INFO] [talker_qos]: Publishing: "Hello World: 1"',
    ]
    output, _ = heard.communicate(timeout=10)
    assert re.search(r'\[listener_qos\]: I heard: \[Hello World: \d\]\n$', output)
    assert heard.returncode == 0


@pytest.mark.parametrize(
    ('options', 'qos'),
    [((), ReliabilityPolicy.BEST_EFFORT), (('--reliable',), ReliabilityPolicy.RELIABLE)],
)
def test_the_option_sets_reliability(
    processes: Any, domain: int, options: tuple[str, ...], qos: ReliabilityPolicy
) -> None:
    word = 'Reliable' if options else 'Best effort'
    talker = processes.start(program('talker_qos'), *options, ready=f'{word} talker')
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'student')
        wait_until(
            lambda: node.count_publishers('/chatter') == 1, timeout_sec=10, what='a publisher'
        )
        (info,) = node.get_publishers_info_by_topic('/chatter')
    assert info.qos_profile.reliability == qos
    end(talker)


def test_a_wrong_option_is_refused() -> None:
    done = run('talker_qos', '--rely')
    assert done.returncode == 2
    assert done.stdout.startswith('usage: talker_qos ')


@pytest.mark.parametrize('client', ['add_two_ints_client', 'add_two_ints_client_async'])
def test_a_sum_is_asked_for_until_somebody_adds(processes: Any, client: str) -> None:
    asking = processes.start(program(client), ready='service not available, waiting again...')
    server = processes.start(program('add_two_ints_server'))
    find_line(server.stdout, r'\[add_two_ints_server\]: Incoming request$')
    assert server.stdout.readline() == 'a: 2 b: 3\n'
    output, _ = asking.communicate(timeout=10)
    assert lines_of(output)[-1] == '[INFO] [add_two_ints_client]: Result of add_two_ints: 5'
    assert asking.returncode == 0
    end(server, signal.SIGTERM)


def test_introspection_tells_what_its_parameters_say(processes: Any, domain: int) -> None:
    events: list[AddTwoInts.Event] = []
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'student')
        node.create_subscription(
            AddTwoInts.Event, '/add_two_ints/_service_event', events.append, 10
        )
        both = processes.start(
            *(program('introspection'), '--ros-args'),
            *('-p', 'client_configure_introspection:=contents'),
            *('-p', 'service_configure_introspection:=metadata'),
        )
        find_line(both.stdout, r'\[introspection_client\]: Result of add_two_ints: 5')
        # From the client what it sent and got; from the service that something came and went.
        wait_until(
            lambda: {0, 1, 2, 3} <= {event.info.event_type for event in events},
            timeout_sec=10,
            what=lambda: f'four kinds of events in {events}',
        )
    sent = {e.info.event_type: [(r.a, r.b) for r in e.request] for e in events}
    assert (sent[0], sent[1]) == ([(2, 3)], [])
    assert {e.info.event_type: [r.sum for r in e.response] for e in events}[3] == [5]
    end(both)


@pytest.mark.usefixtures('domain')
def test_introspection_refuses_another_word() -> None:
    done = run('introspection', '--ros-args', '-p', 'client_configure_introspection:=all')
    assert done.returncode == 2
    assert "must be one of 'disabled', 'metadata', or 'contents'" in done.stdout
    assert done.stdout.count('\n') == 1


def test_to_set_one_parameter_sets_the_other(processes: Any, domain: int, ros2_here: Any) -> None:
    node = processes.start(program('set_parameters_callback'))
    wait_for_node(domain, 'set_parameters_callback')
    answer = ros2_here('param', 'set', '/set_parameters_callback', 'param1', '28.0')
    assert answer.out == 'Set parameter successful\n'
    values = [
        ros2_here('param', 'get', '/set_parameters_callback', f'param{n}').out for n in (1, 2)
    ]
    assert values == ['Double value is: 28.0\n', 'Double value is: 4.0\n']
    end(node)


@pytest.fixture
def board(processes: Any, tmp_path: Path) -> Any:
    """Start what the page on arguments of nodes starts."""
    (tmp_path / 'demo_params.yaml').write_text(f'{BOARD}: {{ros__parameters: {{some_int: 42}}}}')
    return processes.start(
        *('ros2', 'run', 'demo_nodes_cpp', BOARD, '--ros-args', '-p', 'a_string:=Hello world'),
        *('--params-file', 'demo_params.yaml', '-p', 'some_lists.some_doubles:=[3.14, 2.718]'),
        ready=f"Parameter blackboard '/{BOARD}' is ready, with 5 parameters",
    )


def test_a_blackboard_keeps_what_it_is_given(board: Any, domain: int, ros2_here: Any) -> None:
    assert ros2_here('param', 'set', BOARD, 'new', '3.45').out == 'Set parameter successful\n'
    assert (
        ros2_here('param', 'dump', BOARD).out.strip()
        == f"""\
/{BOARD}:
  ros__parameters:
    a_string: Hello world
    new: 3.45
    some_int: 42
    some_lists:
      some_doubles:
      - 3.14
      - 2.718
    start_type_description_service: true
    use_sim_time: false"""
    )
    end(board)


@pytest.mark.usefixtures('board')
def test_a_blackboard_keeps_what_the_client_sets() -> None:
    done = run('async_param_client')
    assert done.returncode == 0
    said = [line.removeprefix('[INFO] [async_param_client]: ') for line in lines_of(done.stdout)]
    titles = ['Setting parameters:', 'Listing Parameters:', 'Getting parameters:']
    titles += ['Loading parameters: ', 'Deleting parameters: ']
    assert [line for line in said if not line.startswith(' ')] == titles
    assert said.count('        successful: True') == 3 + 5 + 3
    for line in (
        '    - string_parameter',
        '    - string_parameter: Fee Fi Fo Fum',
        '        value: 12',
        '        value: One fish, two fish, Red fish, blue fish',
    ):
        assert line in said


@pytest.mark.usefixtures('domain')
def test_without_such_a_node_the_client_says_what_to_start() -> None:
    done = run('async_param_client')
    assert done.returncode == 1
    assert f'there is no node {BOARD}: start it before this demo' in done.stdout


@pytest.mark.usefixtures('domain')
def test_matched_events_are_those_of_jazzy() -> None:
    done = run('matched_event_detect')
    changed = 'The changed number of connected {0} is {1} and current number of connected {0} is '
    expected = []
    for node, kind in (('sub', 'subscription'), ('pub', 'publisher')):
        maker, watcher = f'[INFO] [multi_{node}_node]: ', '[INFO] [matched_event_detection_node]: '
        expected += [
            f'{maker}Create a new {kind}.',
            f'{watcher}First {kind} is connected.',
            f'{maker}Create a new {kind}.',
            f'{watcher}{changed.format(kind, 1)}2',
            f'{maker}Destroy a {kind}.',
            f'{watcher}{changed.format(kind, -1)}1',
            f'{maker}Destroy a {kind}.',
            f'{watcher}Last {kind} is disconnected.',
        ]
    assert lines_of(done.stdout) == expected
    assert done.returncode == 0


@pytest.mark.usefixtures('domain')
def test_a_logger_service_changes_what_is_logged() -> None:
    done = run('use_logger_service')
    expected, levels = [], ('DEBUG', 'INFO', 'WARN', 'ERROR')
    steps = (('default', 'INFO', 0), ('debug', 'DEBUG', 10), ('warn', 'WARN', 30))
    for number, (name, least, value) in enumerate((*steps, ('error', 'ERROR', 40)), 1):
        expected.append(f'[INFO] [TestNode]: Output with {name} logger level:')
        for level in levels[levels.index(least) :]:
            line = f'Output {number} with {level} logger level.'
            expected.append(f'[{level}] [LoggerServiceNode]: {line}')
        expected.append(f'[INFO] [TestNode]: Current logger level: {value}')
    assert lines_of(done.stdout) == expected
    assert done.returncode == 0


def test_numbers_of_fibonacci_come_one_by_one(processes: Any) -> None:
    client = processes.start(program('fibonacci_action_client'))
    server = processes.start(program('fibonacci_action_server'))
    find_line(server.stdout, r'\[fibonacci_action_server\]: Executing goal\.\.\.$')
    find_line(server.stdout, r"Feedback: array\('i', \[0, 1, 1\]\)$")
    find_line(client.stdout, r'\[fibonacci_action_client\]: Goal accepted :\)$')
    find_line(client.stdout, r"Received feedback: array\('i', \[0, 1, 1, 2\]\)$")
    end(server)  # in the middle of a goal: nobody will ever tell the result
    find_line(client.stdout, r'The action server ended before it had answered$')
    assert client.wait(timeout=10) == 1


def test_orders_that_int32_cannot_hold_are_rejected(processes: Any, ros2_here: Any) -> None:
    server = processes.start(program('fibonacci_action_server'))
    send = ('action', 'send_goal', '/fibonacci', 'action_tutorials_interfaces/action/Fibonacci')
    assert 'Goal was rejected.' in ros2_here(*send, '{order: 47}').out
    find_line(server.stdout, r'order=47 is refused: the numbers up to order 46 fit an int32$')
    answer = ros2_here(*send, '{order: 2}')
    assert 'SUCCEEDED' in answer.out
    assert [int(n) for n in re.findall(r'^- (\d+)$', answer.out, re.MULTILINE)] == [0, 1, 1]
    end(server)


@pytest.mark.parametrize(
    ('name', 'number'),
    [
        ('add_two_ints_client', signal.SIGINT),
        ('async_param_client', signal.SIGTERM),
        ('async_param_client', signal.SIGHUP),
        ('fibonacci_action_client', signal.SIGINT),
        ('listener_qos', signal.SIGTERM),
    ],
)
def test_a_signal_ends_what_waits_for_others(
    processes: Any, domain: int, name: str, number: int
) -> None:
    waiting = processes.start(program(name))
    wait_for_node(domain, name)
    end(waiting, number)


def test_a_program_with_nohup_outlives_its_terminal(processes: Any, domain: int) -> None:
    listener = processes.start('nohup', program('listener'))
    wait_for_node(domain, 'listener')
    listener.send_signal(signal.SIGHUP)
    talker = processes.start(program('talker'))
    find_line(listener.stdout, r'\[listener\]: I heard: ')
    end(talker)
    end(listener)
