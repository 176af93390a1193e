# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Iterator
import fcntl
import os
import pty
import signal
import subprocess
import sys
import termios
from typing import Any

from geometry_msgs.msg import Twist
from husky_driver.keys import HELP, Keyboard, MOVES, split_keys
from husky_driver.motion import Command, STOP
from husky_driver.teleop import main
from playpen_testing.keyboard import CTRL_C
from playpen_testing.keyboard import Keyboard as Terminal
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node

# The lark of the rclpy wheels imports modules that Python is about to drop.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")


@pytest.mark.parametrize(
    ('key', 'command'),
    [
        ('i', (0.5, 0.0)),
        (',', (-0.5, 0.0)),
        ('j', (0.0, 1.0)),
        ('l', (0.0, -1.0)),
        ('u', (0.5, 1.0)),
        ('o', (0.5, -1.0)),
        ('m', (-0.5, -1.0)),
        ('.', (-0.5, 1.0)),
        ('\x1b[A', (0.5, 0.0)),
        ('\x1bOD', (0.0, 1.0)),
        ('k', (0.0, 0.0)),
        ('?', (0.0, 0.0)),
    ],
)
def test_a_key_means_what_it_means_in_teleop_twist_keyboard(
    key: str, command: tuple[float, float]
) -> None:
    keyboard = Keyboard()
    keyboard.press(key, 10.0)
    assert keyboard.command(10.1) == command


def test_the_help_keeps_the_table_of_the_keys(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(['teleop', '--help'])
    assert HELP in capsys.readouterr().out


def test_a_released_key_stops_the_robot() -> None:
    keyboard = Keyboard()
    keyboard.press('i', 0.0)
    assert keyboard.command(0.5) == Command(0.5, 0.0)
    assert keyboard.command(0.61) == STOP


def test_a_held_key_that_is_released_stops_the_robot_sooner() -> None:
    keyboard = Keyboard()
    for now in (0.0, 0.5, 0.53, 0.56):
        keyboard.press('i', now)
    assert keyboard.command(0.7) == Command(0.5, 0.0)
    assert keyboard.command(0.77) == STOP


def test_speeds_change_by_a_tenth_and_keep_the_limits() -> None:
    keyboard = Keyboard()
    keyboard.press('w', 0.0)
    assert (keyboard.speed_m_s, keyboard.turn_rad_s) == pytest.approx((0.55, 1.0))
    keyboard.press('c', 0.0)
    assert keyboard.turn_rad_s == pytest.approx(0.9)
    keyboard.press('z', 0.0)
    assert (keyboard.speed_m_s, keyboard.turn_rad_s) == pytest.approx((0.495, 0.81))
    for _ in range(50):
        keyboard.press('q', 0.0)
    assert (keyboard.speed_m_s, keyboard.turn_rad_s) == (1.0, 2.0)


def test_an_arrow_is_one_key() -> None:
    assert split_keys('i\x1b[Aj') == ['i', '\x1b[A', 'j']
    assert split_keys('\x1bOP') == ['\x1bOP'], 'F1 counts as Esc, which ends'
    assert all(split_keys(key) == [key] for key in MOVES)


@pytest.fixture
def domain_of_programs(domain: int, monkeypatch: pytest.MonkeyPatch) -> int:
    """Give the domain of the test to the programs that it starts, too."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    monkeypatch.setenv('PYTHONPATH', ':'.join(sys.path))
    return domain


@pytest.fixture
def received(domain_of_programs: int) -> Iterator[list[Command]]:
    """Collect the commands on the graph."""
    commands: list[Command] = []

    def listen(robot: Node) -> None:
        topic = 'husky_velocity_controller/cmd_vel'
        robot.create_subscription(
            Twist, topic, lambda m: commands.append(Command(m.linear.x, m.angular.z)), 10
        )

    with SpunNodes(domain_of_programs) as nodes:
        nodes.start(Node, 'robot', before_spin=listen)
        yield commands


def test_a_released_key_or_a_closed_terminal_stops_the_robot(
    received: list[Command],
) -> None:
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, '-m', 'husky_driver.teleop'],
        stdin=theirs,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
        # As in a login over SSH: the terminal that goes away is the one of the session.
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
    )
    os.close(theirs)
    forward = Command(0.5, 0.0)

    def driving() -> bool:
        os.write(ours, b'i')
        return received[-1:] == [forward]

    try:
        wait_until(driving, timeout_sec=20.0, what='command of 0.5 m/s')
        wait_until(lambda: received[-1] == STOP, timeout_sec=5.0, what='stop after the release')
        assert process.poll() is None
        wait_until(driving, timeout_sec=5.0, what='command of 0.5 m/s')
        os.close(ours)
        assert process.wait(timeout=10.0) == 0
        wait_until(lambda: received[-1] == STOP, timeout_sec=5.0, what='stop')
    finally:
        process.kill()
        process.wait()


@pytest.mark.usefixtures('domain_of_programs')
def test_keys_get_through_again_after_ctrl_z_and_fg() -> None:
    terminal = Terminal(sys.executable, '-m', 'husky_driver.teleop')
    try:
        terminal.wait_for_text('forward, with a turn')
        terminal.press('w')
        terminal.wait_for_text('0.55 m/s')
        terminal.put_back()  # as a shell does when it has stopped a program
        terminal.send_signal(signal.SIGCONT)
        wait_until(lambda: not terminal.is_as_before(), timeout_sec=5.0, what='terminal for keys')
        terminal.press('w')
        terminal.wait_for_text('0.61 m/s')
        terminal.press(CTRL_C)
        assert terminal.process.wait(timeout=10.0) == 0
        assert terminal.is_as_before()
    finally:
        terminal.close()


def test_without_a_simulator_or_with_a_wrong_parameter_it_says_so(
    domain_of_programs: int,
) -> None:
    ours, theirs = pty.openpty()
    command = [sys.executable, '-m', 'husky_driver.teleop', '--ros-args', '-p']
    streams: dict[str, Any] = {
        'stdin': theirs,
        'stdout': subprocess.DEVNULL,
        'stderr': subprocess.PIPE,
    }
    with subprocess.Popen([*command, 'speed:=0.3'], text=True, **streams) as process:
        assert process.stderr is not None
        # Its carriage return, over the line that shows the speed, counts as a line.
        hint = process.stderr.readline() + process.stderr.readline()
        process.terminate()
        assert process.wait(timeout=10.0) == 0
    assert 'nobody takes /husky_velocity_controller/cmd_vel yet' in hint
    assert f'ROS_DOMAIN_ID={domain_of_programs}' in hint
    for wrong, message in (('sped:=0.3', 'did you mean speed'), ('speed:=3.0', '0.01 to 1')):
        refused = subprocess.run([*command, wrong], text=True, timeout=20.0, **streams)
        assert refused.returncode == 2
        assert message in refused.stderr
    os.close(ours)
    os.close(theirs)


def test_without_a_terminal_it_says_so_in_one_line() -> None:
    process = subprocess.run(
        [sys.executable, '-m', 'husky_driver.teleop'],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=20.0,
        env=dict(os.environ, PYTHONPATH=':'.join(sys.path)),
    )
    assert process.returncode == 2
    assert process.stderr == 'teleop: needs a terminal to read keys from; run it in one\n'
