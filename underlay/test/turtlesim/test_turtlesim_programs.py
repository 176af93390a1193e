# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What moves turtles: the keys of a real terminal, a square, an imitation, two turtlesims."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
import math
import re
import signal
import time
from typing import Any

from playpen_testing.keyboard import CTRL_C, DOWN, Keyboard, LEFT, RIGHT, UP
from playpen_testing.processes import Process, Processes
from playpen_testing.turtles import TurtleClient
from playpen_testing.waiting import wait_until
import pytest
from turtlesim.srv import Spawn

TELEOP = ('ros2', 'run', 'turtlesim', 'turtle_teleop_key')
HELP = [
    'The arrow keys move turtle1.',
    'g, t, r, e, d, c, v and b turn it to a direction: they lie round f as directions do.',
    'f ends such a turn, q this program.',
]


def press_until(
    keyboard: Keyboard, keys: str, fact: Callable[[Any], bool], student: TurtleClient
) -> None:
    """Press keys as a person does: again where nothing comes of it."""

    def works() -> bool:
        keyboard.press(keys)
        end = time.monotonic() + 0.5
        while time.monotonic() < end:
            if fact(student.pose()):
                return True
        return False

    wait_until(works, timeout_sec=20.0, what=lambda: f'{keys!r}, in {student.pose()}')


@pytest.fixture
def keyboard(student: TurtleClient) -> Iterator[Keyboard]:
    """Start turtle_teleop_key in a terminal, beside a turtlesim."""
    terminal = Keyboard(*TELEOP)
    terminal.wait_for_text(HELP[-1])
    yield terminal
    terminal.close()


def _goes(pose: Any, *, forward: float, turn: float) -> bool:
    return bool((pose.linear_velocity, pose.angular_velocity) == (forward, turn))


def test_arrows_move_the_turtle(keyboard: Keyboard, student: TurtleClient) -> None:
    assert keyboard.shown.split('\r\n')[: len(HELP)] == HELP
    for keys, forward, turn in ((UP, 2.0, 0.0), (LEFT, 0.0, 2.0), (RIGHT, 0.0, -2.0)):
        press_until(keyboard, keys, partial(_goes, forward=forward, turn=turn), student)
    before = student.pose()
    way = (math.cos(before.theta), math.sin(before.theta))
    press_until(
        keyboard,
        DOWN,
        lambda pose: (pose.x - before.x) * way[0] + (pose.y - before.y) * way[1] < -0.3,
        student,
    )


def test_letters_turn_to_where_they_lie_round_f(keyboard: Keyboard, student: TurtleClient) -> None:
    directions = {key: number * math.pi / 4 for number, key in enumerate('gtredcvb')}

    def is_there(pose: Any, key: str) -> bool:
        off = abs(math.remainder(pose.theta - directions[key], math.tau))
        return off < 0.025 and not pose.angular_velocity

    for key in 'tredcvbg':  # it looks to where g lies
        assert not is_there(student.pose(), key), key
        press_until(keyboard, key, partial(is_there, key=key), student)


def test_f_cancels_a_rotation(
    keyboard: Keyboard, student: TurtleClient, turtlesim: Process
) -> None:
    press_until(keyboard, 'd', lambda pose: pose.angular_velocity, student)
    # Again where the answer to the goal is still under way: there is nothing to cancel before.
    press_until(keyboard, 'f', lambda _: 'Rotation goal canceled' in turtlesim.output, student)


@pytest.mark.parametrize('end', ['q', CTRL_C])
def test_q_and_ctrl_c_leave_the_terminal_as_it_was(keyboard: Keyboard, end: str) -> None:
    assert not keyboard.is_as_before()
    start = time.monotonic()
    keyboard.press(end)
    assert keyboard.process.wait(timeout=10.0) == 0
    assert time.monotonic() - start < 2.0
    assert keyboard.is_as_before()
    keyboard.wait_for_text(HELP[-1])
    assert 'Traceback' not in keyboard.shown


def test_without_a_terminal_keys_are_refused_in_a_line(processes: Processes) -> None:
    refused = processes.start(*TELEOP)
    assert refused.wait() == 2
    assert refused.lines[0] == (
        'turtle_teleop_key: needs a terminal to read keys from; run it in one'
    )


def test_a_parameter_scales_the_keys(student: TurtleClient) -> None:
    terminal = Keyboard(*TELEOP, '--ros-args', '-p', 'scale_linear:=0.5')
    try:
        terminal.wait_for_text(HELP[-1])
        press_until(terminal, UP, lambda pose: pose.linear_velocity == 0.5, student)
    finally:
        terminal.close()


def test_draw_square_resets_and_goes_to_its_corners(
    processes: Processes, student: TurtleClient, turtlesim: Process
) -> None:
    square = processes.start('ros2', 'run', 'turtlesim', 'draw_square')
    square.wait_for_text('New goal [7.544445 5.544445, 0.000000]')
    turtlesim.wait_for_text('Resetting turtlesim.')
    square.wait_for_text('Reached goal')
    square.wait_for_text(', 1.570796]')
    goals = [re.findall(r'[-\d.]+', line.partition('New goal')[2]) for line in square.lines]
    x, _, theta = next(map(float, goal) for goal in reversed(goals) if goal)
    assert x == pytest.approx(7.5, abs=0.2)
    assert theta == pytest.approx(math.pi / 2, abs=0.01)
    student.wait_for_pose(lambda pose: pose.theta > 0.5, 'a turtle that turns')
    _ends_by_ctrl_c(square)


def test_mimic_lets_a_turtle_do_as_another(
    processes: Processes, student: TurtleClient, turtlesim: Process
) -> None:
    student.call(Spawn, 'spawn', x=2.0, y=2.0, theta=0.0, name='turtle2')
    remaps = ('input/pose:=turtle1/pose', 'output/cmd_vel:=turtle2/cmd_vel')
    mimic = processes.start(
        *('ros2', 'run', 'turtlesim', 'mimic', '--ros-args'),
        *(word for remap in remaps for word in ('-r', remap)),
    )

    def is_followed() -> bool:
        student.command('turtle1', x=1.0, turn=1.0)
        return bool(student.pose('turtle2').theta > 0.8)

    def tells() -> str:
        """Tell how far a command got: to turtle1, to mimic, back to turtle2."""
        listens = student.node.get_subscriptions_info_by_topic('turtle1/pose')
        commands = student.node.get_publishers_info_by_topic('turtle2/cmd_vel')
        return (
            f'a turtle2 that turns as turtle1: {student.pose("turtle2")}, {student.pose()}; '
            f'to turtle1/pose listen {[end.node_name for end in listens]}, '
            f'turtle2 is commanded by {[end.node_name for end in commands]}'
        )

    wait_until(is_followed, timeout_sec=20.0, what=tells)
    assert 'turtle_mimic' in student.node.get_node_names()
    _ends_by_ctrl_c(mimic)


@pytest.mark.usefixtures('own_domain')
def test_two_turtlesims_are_launched_and_ended(processes: Processes) -> None:
    launch = processes.start('ros2', 'launch', 'turtlesim', 'multisim.launch.py')
    for namespace in ('turtlesim1', 'turtlesim2'):
        launch.wait_for_text(f'Starting turtlesim with node name /{namespace}/turtlesim')
    wait_until(
        lambda: len(set(re.findall(r'http://127\.0\.0\.1:\d+/', launch.output))) == 2,
        timeout_sec=20.0,
        what='a page of each',
    )
    with TurtleClient() as student:
        student.command('turtlesim2/turtle1', x=1.0)
        student.wait_for_pose(lambda pose: pose.x > 6.0, 'a turtle', 'turtlesim2/turtle1')
        assert student.pose('turtlesim1/turtle1').x == pytest.approx(5.544445)
    start = time.monotonic()
    launch.signal(signal.SIGINT)
    launch.wait()
    assert time.monotonic() - start < 3.0
    assert 'Traceback' not in launch.output


def _ends_by_ctrl_c(process: Process) -> None:
    start = time.monotonic()
    process.signal(signal.SIGINT)
    assert process.wait() == 0
    assert time.monotonic() - start < 2.0
    assert 'Traceback' not in process.output
