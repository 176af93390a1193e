# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtlesim in a process of its own, and what a node hears of it over DDS."""

from __future__ import annotations

from itertools import pairwise
import math
import signal
import time
from typing import Any

from action_msgs.msg import GoalStatus
from playpen_testing.here import run_here
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
import psutil
import pytest
from rcl_interfaces.srv import DescribeParameters, SetParameters
from rclpy.parameter import Parameter
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

MIDDLE = 5.544444561
SIDE = 11.088889122
PEN, WHITE = (0xB3, 0xB8, 0xFF), (255, 255, 255)
NODE = ('ros2', 'run', 'turtlesim', 'turtlesim_node', '-platform', 'offscreen')


def place(pose: Any) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_it_begins_with_a_turtle_and_ends_by_a_signal(
    own_turtlesim: Process, number: signal.Signals
) -> None:
    with TurtleClient() as student:
        assert place(student.pose()) == pytest.approx((MIDDLE, MIDDLE, 0.0))
    logged = [line for line in own_turtlesim.lines if '[turtlesim]: ' in line]
    assert [line.partition(']: ')[2] for line in logged[:2]] == [
        'Starting turtlesim with node name /turtlesim',
        'Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]',
    ]
    children = psutil.Process(own_turtlesim.pid).children(recursive=True)
    node = next(child for child in children if '-m' in child.cmdline())
    start = time.monotonic()
    node.send_signal(number)
    assert own_turtlesim.wait() == 0  # `ros2 run` ends as its node does
    assert time.monotonic() - start < 2.0
    assert not node.is_running()
    assert 'Traceback' not in own_turtlesim.output


def test_poses_and_colours_come_every_16_ms(student: TurtleClient) -> None:
    counts = {'pose': 0, 'color_sensor': 0}
    for kind, topic in ((Pose, 'pose'), (Color, 'color_sensor')):
        student.node.create_subscription(
            kind,
            f'turtle1/{topic}',
            lambda _, topic=topic: counts.update({topic: counts[topic] + 1}),
            7,
        )
    student.wait_for(lambda: min(counts.values()) > 0, 'the first of each')

    def sec_of_125() -> tuple[float, int]:
        """Return how long 125 poses take, and how many colours come with them."""
        before, began = dict(counts), time.monotonic()
        student.wait_for(lambda: counts['pose'] >= before['pose'] + 125, '125 poses')
        return time.monotonic() - began, counts['color_sensor'] - before['color_sensor']

    deadline, took_sec = time.monotonic() + 60.0, math.inf
    # A moment without a processor costs some of them: then once more.
    while took_sec >= 3.0:
        assert time.monotonic() < deadline, f'125 poses never came in time, but in {took_sec} s'
        took_sec, colours = sec_of_125()
        assert took_sec > 1.7  # what waited before the first comes at once
    assert colours == pytest.approx(125, abs=10)


def test_a_command_moves_the_turtle_for_a_second(student: TurtleClient) -> None:
    deadline, turned = time.monotonic() + 60.0, 0.0
    # A moment without a processor costs frames, of 16 ms each: then once more.
    while turned < 1.72:
        assert time.monotonic() < deadline, f'it never turned for a second, but by {turned} rad'
        student.call(Empty, 'reset')
        student.pose()
        student.command('turtle1', x=2.0, turn=1.8)
        going = student.wait_for_pose(lambda pose: pose.linear_velocity > 0, 'a pose of a move')
        assert (going.linear_velocity, going.angular_velocity) == pytest.approx((2.0, 1.8))
        stood = student.wait_for_pose(lambda pose: pose.linear_velocity == 0, 'the end of a move')
        turned = stood.theta
        assert turned < 1.88
        radius = 2.0 / 1.8  # v / w
        assert stood.x == pytest.approx(MIDDLE + radius * math.sin(turned), abs=0.05)
        assert stood.y == pytest.approx(MIDDLE + radius * (1 - math.cos(turned)), abs=0.05)


def test_a_wall_holds_the_turtle_and_warns(student: TurtleClient, turtlesim: Process) -> None:
    student.command('turtle1', x=10.0)
    student.wait_for_pose(lambda pose: pose.x == pytest.approx(SIDE), 'a turtle at the wall')
    turtlesim.wait_for_text('Oh no! I hit the wall! (Clamping from [x=11.')
    assert any('[WARN]' in line and ', y=5.544445])' in line for line in turtlesim.lines)


@pytest.mark.usefixtures('default_parameters')
def test_holonomic_turtles_go_sideways_and_others_do_not(student: TurtleClient) -> None:
    student.pose()
    student.command('turtle1', x=0.5, y=1.0)
    student.wait_for_pose(lambda pose: pose.linear_velocity == pytest.approx(0.5), 'only ahead')
    set_parameter(student, 'holonomic', True)
    student.command('turtle1', x=0.5, y=1.0)
    student.wait_for_pose(
        lambda pose: pose.linear_velocity == pytest.approx(math.hypot(0.5, 1.0)), 'sideways too'
    )
    student.wait_for_pose(lambda pose: pose.y > MIDDLE + 0.5, 'a turtle above')


def test_spawned_turtles_have_names_and_topics(student: TurtleClient, turtlesim: Process) -> None:
    assert student.call(Spawn, 'spawn', x=2.0, y=3.0, theta=0.2, name='').name == 'turtle2'
    assert student.call(Spawn, 'spawn', x=4.0, y=3.0, name='mikey').name == 'mikey'
    assert place(student.pose('turtle2')) == pytest.approx((2.0, 3.0, 0.2))
    turtlesim.wait_for_text(
        'Spawning turtle [turtle2] at x=[2.000000], y=[3.000000], theta=[0.200000]'
    )
    student.command('mikey', x=1.0)
    student.wait_for_pose(lambda pose: pose.x > 4.5, 'a turtle that goes', 'mikey')
    assert student.pose('turtle2').x == pytest.approx(2.0)


def test_a_turtle_that_cannot_be_is_refused(student: TurtleClient, turtlesim: Process) -> None:
    refused: tuple[tuple[dict[str, Any], str], ...] = (
        ({'name': 'turtle1'}, 'A turtle named [turtle1] already exists'),
        ({'name': 'a b'}, 'A turtle cannot be named [a b]: Invalid topic name'),
        ({'name': '1st'}, 'A turtle cannot be named [1st]: Invalid topic name'),
        ({'name': '{what}'}, 'unknown substitution: {what}'),
        ({'name': 't' * 230}, 'A turtle cannot be named [ttt'),
        ({'x': math.nan}, 'A turtle cannot be put at x=nan'),
        ({'theta': math.inf}, 'theta=inf: it needs finite numbers'),
    )
    for number, (fields, said) in enumerate(refused, 2):
        assert student.call(Spawn, 'spawn', **fields).name == '', fields
        turtlesim.wait_for_text(said)
        assert student.call(Spawn, 'spawn', x=1.0).name == f'turtle{number}', fields  # it goes on


def test_a_killed_turtle_is_gone_with_its_topics(
    student: TurtleClient, turtlesim: Process
) -> None:
    student.pose()
    student.call(Kill, 'kill', name='turtle1')
    student.wait_for(
        lambda: (
            not student.node.count_publishers('/turtle1/pose')
            and not any(
                'turtle1' in name for name, _ in student.node.get_service_names_and_types()
            )
        ),
        'the end of its topics and services',
    )
    student.call(Kill, 'kill', name='turtle1')
    turtlesim.wait_for_text('Tried to kill turtle [turtle1], which does not exist')
    assert student.call(Spawn, 'spawn', name='turtle1').name == 'turtle1'


def test_colours_are_those_of_the_pens(student: TurtleClient) -> None:
    assert student.colour() == WHITE
    student.command('turtle1', x=1.0)
    student.wait_for_pose(lambda pose: pose.x > MIDDLE + 0.2, 'a turtle that goes')
    assert student.colour() == PEN
    student.call(SetPen, 'turtle1/set_pen', r=10, g=200, b=30, width=9)
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=1.0, y=1.0, theta=0.0)
    student.wait_for_pose(lambda pose: pose.y == 1.0, 'the end of the line')
    student.wait_for(lambda: student.colour() == (10, 200, 30), 'the colour of the new pen')
    student.call(SetPen, 'turtle1/set_pen', r=255, off=1)
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=9.0, y=2.0, theta=0.0)
    student.wait_for(lambda: student.colour() == WHITE, 'white beside the lines')
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=1.0, y=1.0, theta=0.0)
    student.wait_for(lambda: student.colour() == (10, 200, 30), 'the line that was there')
    student.call(Empty, 'clear')
    student.wait_for(lambda: student.colour() == WHITE, 'white after the lines were cleared')


def test_teleports_go_to_a_place_or_ahead(student: TurtleClient, turtlesim: Process) -> None:
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=2.0, y=3.0, theta=1.0)
    assert place(student.wait_for_pose(lambda pose: pose.x == 2.0, 'there'))[1:] == (3.0, 1.0)
    student.call(TeleportRelative, 'turtle1/teleport_relative', linear=2.0, angular=0.5)
    there = student.wait_for_pose(lambda pose: pose.theta > 1.2, 'ahead')
    expected = (2.0 + 2.0 * math.cos(1.5), 3.0 + 2.0 * math.sin(1.5), 1.5)
    assert place(there) == pytest.approx(expected, abs=1e-5)
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=math.nan)
    turtlesim.wait_for_text('A turtle cannot go to nan, 0.0, 0.0: it needs finite numbers')
    assert place(student.pose()) == pytest.approx(expected, abs=1e-5)


def test_reset_begins_anew(student: TurtleClient, turtlesim: Process) -> None:
    student.call(Spawn, 'spawn', x=1.0, y=1.0, name='other')
    student.call(TeleportAbsolute, 'turtle1/teleport_absolute', x=2.0, y=3.0)
    student.call(Empty, 'reset')
    turtlesim.wait_for_text('Resetting turtlesim.')
    student.wait_for_pose(lambda pose: pose.x == pytest.approx(MIDDLE), 'a turtle in the middle')
    assert student.colour() == WHITE
    student.wait_for(lambda: not student.node.count_publishers('/other/pose'), 'nobody else')
    assert student.call(Spawn, 'spawn').name == 'turtle2'


def test_a_rotation_feeds_back_and_succeeds(student: TurtleClient, turtlesim: Process) -> None:
    goal = student.rotate(1.0)
    status, delta = student.end_of(goal)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert delta == pytest.approx(-1.0, abs=0.025)
    assert student.pose().theta == pytest.approx(1.0, abs=0.021)
    assert len(student.feedback) > 50
    assert all(after <= before for before, after in pairwise(student.feedback))
    assert student.feedback[0] == pytest.approx(1.0, abs=0.1)
    turtlesim.wait_for_text('Rotation goal completed successfully')


def test_a_canceled_rotation_stops_the_turtle(student: TurtleClient, turtlesim: Process) -> None:
    goal = student.rotate(3.0)
    student.wait_for_pose(lambda pose: pose.theta > 0.2, 'a turtle that turns')
    student.result_of(goal.cancel_goal_async(), 'an answer to the wish')
    status, delta = student.end_of(goal)
    assert status == GoalStatus.STATUS_CANCELED
    stood = student.wait_for_pose(lambda pose: pose.angular_velocity == 0.0, 'a standing turtle')
    assert stood.theta == pytest.approx(-delta, abs=0.05)
    assert stood.theta < 2.0
    turtlesim.wait_for_text('Rotation goal canceled')


def test_a_new_goal_aborts_the_one_before(student: TurtleClient, turtlesim: Process) -> None:
    first = student.rotate(3.0)
    second = student.rotate(-0.5)
    assert student.end_of(first)[0] == GoalStatus.STATUS_ABORTED
    assert student.end_of(second)[0] == GoalStatus.STATUS_SUCCEEDED
    turtlesim.wait_for_text(
        'Rotation goal received before a previous goal finished. Aborting previous goal'
    )


def test_a_command_aborts_a_rotation_and_is_obeyed(
    student: TurtleClient, turtlesim: Process
) -> None:
    goal = student.rotate(3.0)
    student.command('turtle1', x=1.0)
    assert student.end_of(goal)[0] == GoalStatus.STATUS_ABORTED
    student.wait_for_pose(lambda pose: pose.linear_velocity == 1.0, 'a turtle that goes')
    turtlesim.wait_for_text('Velocity command received during rotation goal. Aborting goal')


def test_a_goal_without_a_direction_is_rejected(student: TurtleClient) -> None:
    assert not student.rotate(math.nan).accepted


def test_goals_end_with_a_killed_turtle(student: TurtleClient) -> None:
    def is_told(name: str) -> bool:
        assert student.call(Spawn, 'spawn', x=3.0, y=3.0, name=name).name == name
        ended = student.rotate(3.0, name).get_result_async()
        student.wait_for(lambda: len(student.feedback) > 60, 'feedback of a second')
        student.call(Kill, 'kill', name=name)
        try:
            student.wait_for(ended.done, 'the result', timeout_sec=5.0)
        except AssertionError:
            return False
        return bool(ended.result().status == GoalStatus.STATUS_ABORTED)

    # On a busy machine DDS may lose the last word of a server that is gone; not thrice.
    assert any(is_told(f'other{number}') for number in range(3))


def test_killing_and_resetting_under_way_harms_nothing(
    student: TurtleClient, turtlesim: Process
) -> None:
    for number in range(10):
        # Each time another name: what DDS knows of the one before may be late.
        name = f'other{number}'
        assert student.call(Spawn, 'spawn', x=3.0, y=3.0, name=name).name == name
        student.command(name, x=1.0)
        assert student.rotate(2.0, name).accepted
        if number % 2:
            student.call(Kill, 'kill', name=name)
        else:
            student.call(Empty, 'reset')
    assert student.pose().x == pytest.approx(MIDDLE)
    assert turtlesim.returncode is None
    assert not any('Traceback' in line for line in turtlesim.lines)


def test_a_command_that_is_no_velocity_is_refused(
    student: TurtleClient, turtlesim: Process
) -> None:
    said = 'A command is refused: its velocities must be numbers up to 1e+30, not x='
    for velocity in (math.nan, math.inf, -1e31):
        student.command('turtle1', x=velocity)
        turtlesim.wait_for_text(f'{said}{velocity}')
    student.command('turtle1', x=-1e30, turn=1e30)
    student.wait_for_pose(lambda pose: math.isfinite(pose.x) and pose.linear_velocity > 1e29, 'it')


def set_parameter(student: TurtleClient, name: str, value: object) -> Any:
    parameter = Parameter(name, value=value).to_parameter_msg()
    answer = student.call(SetParameters, 'turtlesim/set_parameters', parameters=[parameter])
    return answer.results[0]


@pytest.mark.usefixtures('default_parameters')
def test_parameters_say_what_they_are_and_refuse_the_rest(student: TurtleClient) -> None:
    names = ['background_r', 'background_g', 'background_b', 'holonomic']
    answer = student.call(DescribeParameters, 'turtlesim/describe_parameters', names=names)
    assert [described.description for described in answer.descriptors] == [
        *(f'{colour} channel of the background color' for colour in ('Red', 'Green', 'Blue')),
        'If true, then turtles will be holonomic',
    ]
    (channel,) = answer.descriptors[0].integer_range
    assert (channel.from_value, channel.to_value, channel.step) == (0, 255, 1)
    assert set_parameter(student, 'background_r', 150).successful
    for name, value in (('background_r', 256), ('background_g', -1), ('holonomic', 1)):
        assert not set_parameter(student, name, value).successful


@pytest.mark.usefixtures('own_domain')
def test_bad_arguments_are_refused_in_a_line(
    processes: Processes, capfd: pytest.CaptureFixture[str]
) -> None:
    bad = {
        ('--port', '0'): 'a port is from 1 to 65535',
        ('--prot', '8000'): 'unrecognized arguments: --prot',
        ('--ros-args', '-p', 'background_r:=300'): 'background_r',
        ('--ros-args', '-p', 'holonomic:=7'): 'holonomic',
        ('--ros-args', '-r', '__node:=7'): "Couldn't parse remap rule: '-r __node:=7'",
    }
    module = 'turtlesim_programs.turtlesim_node'
    ended = {words: run_here(capfd, module, *NODE[4:], *words) for words in bad}
    printed = {words: each.out + each.err for words, each in ended.items()}
    assert all(each.status == 2 for each in ended.values()), printed
    refused = processes.start(*NODE, '--port', 'x')
    assert refused.wait() == 2
    printed['--port', 'x'] = refused.output
    bad['--port', 'x'] = 'a port is from 1 to 65535'
    for words, said in bad.items():
        told = [
            line
            for line in printed[words].splitlines()
            if not line.startswith(('usage', '  ', '[ros2run]')) and '[rcl]' not in line
        ]
        assert len(told) == 1, printed[words]
        assert said in told[0], words


@pytest.mark.usefixtures('own_domain')
def test_a_name_and_a_namespace_are_remapped(processes: Processes) -> None:
    node = processes.start(*NODE, '--ros-args', '-r', '__node:=my_turtle', '-r', '__ns:=/zoo')
    node.wait_for_text('Starting turtlesim with node name /zoo/my_turtle')
    with TurtleClient() as student:
        assert student.call(Spawn, 'zoo/spawn', x=2.0, y=3.0).name == 'turtle2'
        assert student.pose('zoo/turtle2').y == pytest.approx(3.0)
        student.command('zoo/turtle2', x=1.0)
        student.wait_for_pose(lambda pose: pose.x > 2.5, 'a turtle that goes', 'zoo/turtle2')
        assert student.end_of(student.rotate(0.5, 'zoo/turtle1'))[0] == 4


def test_fifty_turtles_move_at_once(student: TurtleClient, turtlesim: Process) -> None:
    for number in range(49):
        column, row = number % 7, number // 7
        name = student.call(Spawn, 'spawn', x=2.0 + column, y=2.0 + row, theta=1.0 * number).name
        assert name == f'turtle{number + 2}'
    for number in range(1, 51):
        student.command(f'turtle{number}', x=0.5, turn=1.0)
    student.wait_for_pose(lambda pose: pose.linear_velocity == 0.5, 'the last one', 'turtle50')
    stamps: list[float] = []
    student.node.create_subscription(
        Pose, 'turtle25/pose', lambda _: stamps.append(time.monotonic()), 7
    )
    student.wait_for(lambda: len(stamps) > 100, '100 poses of one of them')
    assert 100 / (stamps[100] - stamps[0]) > 20.0
    assert all('timers' not in line for line in turtlesim.lines)
