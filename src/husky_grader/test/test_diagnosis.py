# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What real programs print, and where real nodes stand in the graph, and what is told of it."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
import os
from pathlib import Path
import signal
import sys

from geometry_msgs.msg import Twist, TwistStamped
from husky_grader.run.diagnosis import (
    COMMAND_TOPIC,
    Graph,
    how_it_ended,
    reasons,
    reasons_of_graph,
    silence,
)
from husky_grader.run.graph import has_other_fields, read_graph
from husky_grader.run.printed import MAX_SHOWN, read_printed, shown
from husky_grader.run.watcher import GraphWatcher
from husky_runtime.children import ChildProcess
from nav_msgs.msg import Odometry
from playpen_testing.waiting import wait_until
import pytest
import rclpy
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    qos_profile_sensor_data,
    QoSProfile,
)
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock

ODOMETRY = '/odometry/filtered'
LAUNCH_FAILED = '[ERROR] [launch]: Caught exception in launch (see debug for traceback): '


def printed_by(program: str, folder: Path, *, until: str = '') -> str:
    """
    Run a program, and return what it prints.

    :param until: what it prints before Ctrl-C; empty: it ends by itself.
    """
    file, log = folder / 'follow_path.py', folder / 'controller.log'
    file.write_text(program)
    with log.open('w') as stream:
        process = ChildProcess([sys.executable, str(file)], os.environ, stream)
        if until:
            wait_until(lambda: until in read_printed(log), what=f'{until}, printed by the program')
            process.send(signal.SIGINT)
        assert process.wait(20.0)
    return read_printed(log)


@pytest.mark.parametrize(
    ('program', 'reason'),
    [
        ("print('starting')\ndef main(:\n", 'follow_path.py line 2: SyntaxError: '),
        ("import math\n\nmath.sqrt('4')\n", 'follow_path.py line 3: TypeError: '),
        (
            'import json\ndef read():\n    return json.loads("{")\nread()\n',
            'follow_path.py line 3: json.decoder.JSONDecodeError: ',
        ),
        (
            'try:\n    {}["x"]\nexcept KeyError:\n    raise ValueError("no such path")\n',
            'follow_path.py line 4: ValueError: no such path',
        ),
        ('import no_such_module\n', 'follow_path.py line 1: ModuleNotFoundError: '),
        (
            'print("x" * 100000)\nraise ValueError("late")\n',
            'follow_path.py line 2: ValueError: late',
        ),
    ],
)
def test_an_error_is_told_with_the_line_of_the_student(
    program: str, reason: str, tmp_path: Path
) -> None:
    printed = printed_by(program, tmp_path)
    assert reasons(printed, '', (), None)[0].startswith(reason), printed


def test_an_error_of_a_launched_program_is_told_too(tmp_path: Path) -> None:
    program, launch = tmp_path / 'follow_path.py', tmp_path / 'drive.launch.yaml'
    program.write_text('limit = 4\nraise ValueError(limit)\n')
    launch.write_text(f'launch: [{{executable: {{cmd: {sys.executable} {program}}}}}]\n')
    log = tmp_path / 'controller.log'
    with log.open('w') as stream:
        process = ChildProcess(['ros2', 'launch', str(launch)], os.environ, stream)
        assert process.wait(20.0)
    told = reasons(read_printed(log), '', (), None)
    assert told == ('follow_path.py line 2: ValueError: 4',), read_printed(log)


def test_of_a_launch_file_the_error_of_its_own_parser_is_told(tmp_path: Path) -> None:
    launch = tmp_path / 'drive.launch.py'
    launch.write_text('raise ValueError(4)\n')
    log = tmp_path / 'controller.log'
    with log.open('w') as stream:
        process = ChildProcess(['ros2', 'launch', str(launch)], os.environ, stream)
        assert process.wait(20.0)
    assert 'ValueError: 4' in reasons(read_printed(log), '', (), 1)[0], read_printed(log)
    several = 'Caught multiple exceptions when trying to load file of format [xml]:'
    printed = (
        f'{LAUNCH_FAILED}{several}\n'
        f' - InvalidFrontendLaunchFileError: {several}\n'
        ' - ParseError: mismatched tag: line 1, column 33\n'
        ' - RuntimeError: Expected only one root\n'
        ' - SyntaxError: invalid syntax (drive.launch.xml, line 1)\n'
    )
    told = 'ParseError: mismatched tag: line 1, column 33'
    assert reasons(printed, '', (), 1) == (f'it crashed (exit code 1): {told}',)
    assert reasons(' - ready', '', (), 1) == ('it crashed (exit code 1): - ready',)
    printed = f'{LAUNCH_FAILED}executed command failed. Command: cat a\ncat: a: No such file\n'
    about = '[INFO] [launch]: All log files can be found below /\n'
    told = 'executed command failed. Command: cat a cat: a: No such file'
    for whole in (f'{about}{printed}', f'{printed}[INFO] [a-1]: process has finished cleanly'):
        assert reasons(whole, '', (), 1) == (f'it crashed (exit code 1): {told}',)
    assert reasons(about, '', (), 1) == ('it crashed (exit code 1)',)


def test_under_ros2_run_the_last_word_of_the_program_is_told(tmp_path: Path) -> None:
    log = tmp_path / 'controller.log'
    with log.open('w') as stream:
        words = ['ros2', 'run', 'husky_driver', 'follow_path', '--waypoints', 'missing.yaml']
        process = ChildProcess(words, os.environ, stream)
        assert process.wait(20.0)
    told = 'it crashed (exit code 2): missing.yaml: no such file'
    assert reasons(read_printed(log), '', (), process.exit_code) == (told,)


@pytest.mark.parametrize(
    ('program', 'told'),
    [
        (
            'import faulthandler, ctypes\nfaulthandler.enable()\nctypes.string_at(0)',
            'Segmentation',
        ),
        (
            'import os, sys\nos.environ["PYTHONHOME"] = "/no"\nos.execv(sys.executable, ["x"])',
            'init',
        ),
    ],
    ids=['in a library', 'at the start'],
)
def test_where_python_itself_ends_its_own_word_is_told(
    tmp_path: Path, program: str, told: str
) -> None:
    (reason,) = reasons(printed_by(program, tmp_path), '', (), 1)
    assert reason.startswith(f'it crashed (exit code 1): Fatal Python error: {told}')


def test_an_end_that_was_asked_for_is_no_error(
    domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    program = (
        'import rclpy, sys\n'
        'sys.excepthook = sys.__excepthook__\n'  # it tells all, as where a ROS is sourced
        "rclpy.init()\nnode = rclpy.create_node('student')\ntry:\n"
        "    print('ready', flush=True)\n    rclpy.spin(node)\nfinally:\n"
        '    while rclpy.ok():\n        pass\n'  # a thread of rclpy's shuts it down; who is first?
        '    rclpy.shutdown()\n'
    )
    printed = printed_by(program, tmp_path, until='ready')
    assert 'RCLError' in printed
    assert reasons(printed, '', (), None) == ()


@pytest.mark.parametrize(
    ('script', 'how'),
    [('exit 7', 'exit code 7'), ('kill -SEGV $$', 'SIGSEGV'), ('kill -40 $$', 'signal 40')],
)
def test_every_way_to_end_has_words(script: str, how: str, tmp_path: Path) -> None:
    with (tmp_path / 'log').open('w') as stream:
        process = ChildProcess(['bash', '-c', script], os.environ, stream)
        assert process.wait(20.0)
    assert reasons('', '', (), process.exit_code) == (f'it crashed ({how})',)


def test_a_velocity_that_is_no_number_is_told(
    student: tuple[Node, Callable[[], Graph]], domain: int, tmp_path: Path
) -> None:
    log = tmp_path / 'simulator.log'
    publisher = student[0].create_publisher(Twist, COMMAND_TOPIC, 10)
    wrong = Twist()
    wrong.linear.x = float('nan')

    def told() -> tuple[str, ...]:
        publisher.publish(wrong)
        return reasons('', read_printed(log), (), None)

    environment = {**os.environ, 'ROS_DOMAIN_ID': str(domain)}
    simulator = [sys.executable, '-m', 'husky_sim.ros.node']
    with log.open('w') as stream, ChildProcess(simulator, environment, stream):
        wait_until(told, what='what the simulator says of nan')
    assert told() == (
        'it commanded linear.x = nan, angular.z = 0.0: a velocity must be a finite number',
    )


def test_of_a_long_log_beginning_and_end_are_kept(tmp_path: Path) -> None:
    log = tmp_path / 'controller.log'
    log.write_text('first\n' + 'x' * 200_000 + '\nlast \x1b[31m\n')
    for text in (read_printed(log), shown(read_printed(log))):
        assert text.startswith('first\n')
        assert 'are left out]\n' in text
        assert '\nlast ' in text
    assert len(shown(read_printed(log))) < MAX_SHOWN + 100
    assert '\x1b' not in shown(read_printed(log))
    assert read_printed(tmp_path / 'nothing') == ''


@pytest.fixture
def nodes(domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Node]]:
    """Give nodes of a student, of a simulator and of the grader."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with ExitStack() as stack:
        nodes: list[Node] = []
        for name in ('follow_path', 'husky_sim', 'grader'):
            context = rclpy.Context()
            rclpy.init(
                context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
            )
            stack.callback(rclpy.shutdown, context=context)
            nodes.append(Node(name, context=context))
            stack.callback(nodes[-1].destroy_node)
        nodes[1].create_publisher(Odometry, 'odometry/filtered', 10)
        nodes[1].create_publisher(Odometry, 'front/scan', qos_profile_sensor_data)
        yield nodes


@pytest.fixture
def student(nodes: list[Node]) -> tuple[Node, Callable[[], Graph]]:
    """Give a student's node beside a simulator, and how the grader sees it."""

    def graph() -> Graph:
        return read_graph(nodes[2], ('husky_sim', 'grader'))

    offered = {'/front/scan', ODOMETRY}
    wait_until(
        lambda: {e.topic for e in graph().other_publishers} >= offered, what='the simulator'
    )
    return nodes[0], graph


def take(_: object) -> None:
    """Take a message; Python 3.10 does not tell rclpy the parameters of a built-in function."""


LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
DEADLINE = QoSProfile(depth=10, deadline=Duration(nanoseconds=10_000_000))
MANUAL = QoSProfile(depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC)
LEASE = QoSProfile(depth=10, liveliness_lease_duration=Duration(nanoseconds=500_000_000))
HEARS_NOTHING = f'it hears nothing of {ODOMETRY}: it asks for'
MISTAKES: dict[str, tuple[Callable[[Node], object], str]] = {
    'misspelt': (
        lambda node: node.create_subscription(Odometry, 'odometry/filterd', take, 10),
        f'it listens to /odometry/filterd, which nobody publishes; did you mean {ODOMETRY}?',
    ),
    'without its namespace': (
        lambda node: node.create_subscription(Odometry, 'filtered', take, 10),
        f'it listens to /filtered, which nobody publishes; did you mean {ODOMETRY}?',
    ),
    'transient local': (
        lambda node: node.create_subscription(Odometry, 'odometry/filtered', take, LATCHED),
        f'it hears nothing of {ODOMETRY}: it asks for TRANSIENT_LOCAL, but that is published '
        'VOLATILE; leave the durability of its QoS profile out',
    ),
    'reliable': (
        lambda node: node.create_subscription(Odometry, 'front/scan', take, 10),
        'it hears nothing of /front/scan: it asks for RELIABLE, but that is published '
        'BEST_EFFORT; subscribe with qos_profile_sensor_data',
    ),
    'a deadline': (
        lambda node: node.create_subscription(Odometry, 'odometry/filtered', take, DEADLINE),
        f'{HEARS_NOTHING} a deadline of 0.01 s, but that is published without; '
        'leave the deadline of its QoS profile out',
    ),
    'liveliness': (
        lambda node: node.create_subscription(Odometry, 'odometry/filtered', take, MANUAL),
        f'{HEARS_NOTHING} MANUAL_BY_TOPIC, but that is published AUTOMATIC; leave the liveliness '
        'of its QoS profile out',
    ),
    'a lease': (
        lambda node: node.create_subscription(Odometry, 'odometry/filtered', take, LEASE),
        f'{HEARS_NOTHING} a liveliness lease of 0.5 s, but that is published without; '
        'leave the lease of its QoS profile out',
    ),
    'another type': (
        lambda node: node.create_subscription(Twist, 'odometry/filtered', take, 10),
        f'it listens to {ODOMETRY} as geometry_msgs/msg/Twist; that topic carries '
        'nav_msgs/msg/Odometry',
    ),
    'commands elsewhere': (
        lambda node: node.create_publisher(Twist, 'cmd_vel', 10),
        f'it publishes geometry_msgs/msg/Twist on /cmd_vel; the Husky listens on {COMMAND_TOPIC}',
    ),
    'commands of another type': (
        lambda node: node.create_publisher(TwistStamped, COMMAND_TOPIC, 10),
        f'it publishes geometry_msgs/msg/TwistStamped on {COMMAND_TOPIC}; the Husky takes '
        'geometry_msgs/msg/Twist',
    ),
    'commands best effort': (
        lambda node: node.create_publisher(Twist, COMMAND_TOPIC, qos_profile_sensor_data),
        f'it publishes {COMMAND_TOPIC} best effort; the Husky listens reliably and hears nothing',
    ),
}


@pytest.mark.parametrize('name', MISTAKES)
def test_a_mistake_on_the_graph_is_told_for_what_it_is(
    name: str, student: tuple[Node, Callable[[], Graph]]
) -> None:
    node, graph = student
    make, reason = MISTAKES[name]
    kept = make(node)
    wait_until(lambda: tuple(reasons_of_graph(graph())), what=reason)
    assert tuple(reasons_of_graph(graph())) == (reason,)
    del kept


def test_nothing_is_told_of_a_node_that_does_it_right(
    student: tuple[Node, Callable[[], Graph]],
) -> None:
    node, graph = student
    kept = [
        node.create_subscription(Odometry, 'odometry/filtered', take, 10),
        node.create_publisher(Twist, COMMAND_TOPIC, 10),
    ]
    wait_until(
        lambda: {each.topic for each in graph().publishers} >= {COMMAND_TOPIC}, what='the graph'
    )
    assert tuple(reasons_of_graph(graph())) == ()
    del kept


SILENT: dict[str, tuple[Callable[[Node], object], str]] = {
    'publishes nothing': (
        lambda node: node.create_subscription(Odometry, 'odom', take, 10),
        'it has no publisher: is one made, and does nothing before it wait?',
    ),
    'has a publisher': (
        lambda node: node.create_publisher(Twist, 'topic_test', 10),
        'it has a publisher there: does it publish again and again, does it spin, and does no '
        'callback wait for an answer (client.call) or for time (Rate.sleep)?',
    ),
    'publishes something else': (
        lambda node: [node.create_publisher(Twist, name, 10) for name in ('turn', 'drive')],
        'it has publishers on /drive and /turn alone',
    ),
    'waits for a clock': (
        lambda node: [
            node.create_publisher(Twist, 'topic_test', 10),
            node.create_subscription(Clock, '/clock', take, 10),
        ],
        'its clock is that of /clock (use_sim_time), which nobody publishes here',
    ),
}


@pytest.mark.parametrize('name', SILENT)
def test_why_nothing_comes_on_a_topic_is_told(
    name: str, student: tuple[Node, Callable[[], Graph]]
) -> None:
    node, graph = student
    make, reason = SILENT[name]
    kept = make(node)
    wait_until(lambda: list(silence(graph(), '/topic_test')) == [reason], what=reason)
    del kept


def test_fields_are_compared_with_what_the_node_itself_listens_to(nodes: list[Node]) -> None:
    program, simulator, grader = nodes
    kept = [
        program.create_publisher(Twist, COMMAND_TOPIC, 10),
        simulator.create_subscription(Odometry, COMMAND_TOPIC, take, 10),
    ]
    wait_until(lambda: grader.count_publishers(COMMAND_TOPIC), what='the publisher')
    wait_until(lambda: grader.count_subscribers(COMMAND_TOPIC), what='a subscription of another')
    twist = 'geometry_msgs/msg/Twist'
    assert not has_other_fields(grader, COMMAND_TOPIC, twist), 'it listens to nothing yet'
    kept.append(grader.create_subscription(Odometry, COMMAND_TOPIC, take, 10))
    wait_until(
        lambda: has_other_fields(grader, COMMAND_TOPIC, twist), what='the fields of Odometry'
    )
    grader.destroy_subscription(kept.pop())
    kept.append(grader.create_subscription(Twist, COMMAND_TOPIC, take, 10))
    wait_until(lambda: not has_other_fields(grader, COMMAND_TOPIC, twist), what='the same fields')


def test_a_mistake_outlives_the_end_of_its_program(nodes: list[Node]) -> None:
    program, simulator, _ = nodes
    subscription = program.create_subscription(Odometry, 'odometry/filterd', take, 10)
    wait_until(
        lambda: simulator.count_publishers('/parameter_events') == len(nodes), what='all nodes'
    )
    watcher = GraphWatcher(simulator, 'lab')

    def told() -> bool:
        watcher.look()
        return any('/odometry/filterd' in reason for reason in watcher.reasons)

    wait_until(told, what='the mistake')
    program.destroy_subscription(subscription)
    wait_until(lambda: not simulator.count_subscribers('odometry/filterd'), what='the end of it')
    assert told(), 'the rest of the program may be about to go'
    assert not told(), 'it goes on'


def test_of_a_launch_file_its_end_is_told_and_not_where_it_lies() -> None:
    """Of 200 characters its path would leave nothing for what is wrong."""
    share = 'built/install/bring_up/share/'
    launch = f'{share}bring_up/launch/talk.launch.py'
    of_launch = 'Caught exception when trying to load file of format [py]: '
    why = 'does not contain the required function'
    printed = (
        f"{LAUNCH_FAILED}{of_launch}InvalidPythonLaunchFileError: launch file at '{launch}' {why}"
    )
    short = launch.removeprefix(share)
    told = f"InvalidPythonLaunchFileError: launch file at '{short}' {why}"
    assert how_it_ended(1, printed) == f'it ended by itself (exit code 1): {told}'
    given = "RCLError: Couldn't parse params file: '--params-file {}a/b.yaml'. Error: Cannot have"
    error = f'Traceback:\n  File "/src/talk.py", line 8\n{given}\n'
    (told,) = reasons(error.format('/home/a/CSE461_07_03/install/a/share/'), '', [], 1)
    assert told == f'it crashed (exit code 1): talk.py line 8: {given.format("")}'


def test_what_the_grader_has_killed_is_not_told_of_the_kernel() -> None:
    killed = 'it ended by itself (SIGKILL, as by the kernel where memory runs out): here'
    assert how_it_ended(-9, 'here\n') == killed
    told = "package 'patrool' not found"
    assert how_it_ended(1, LAUNCH_FAILED + told) == f'it ended by itself (exit code 1): {told}'
    assert reasons(LAUNCH_FAILED + told, '', [], 1)[0] == f'it crashed (exit code 1): {told}'
    note = '[ended by the grader: it had 501 processes and threads; 500 are allowed]'
    assert how_it_ended(-9, f'here\n\n{note}\n') == f'it ended by itself (SIGKILL): {note}'
    assert reasons(f'here\n{note}', '', [], -9)[0] == f'it crashed (SIGKILL): {note}'


@pytest.mark.parametrize('begin', [f'{LAUNCH_FAILED}', '  File "a.py", line 1\nError: '])
def test_the_time_to_tell_an_end_grows_with_what_was_printed(begin: str) -> None:
    # As one that raises an error with the bytes of a picture in it. This took minutes.
    assert how_it_ended(1, f'{begin}{"x" * 2_000_000}\n').endswith('xxx...')
