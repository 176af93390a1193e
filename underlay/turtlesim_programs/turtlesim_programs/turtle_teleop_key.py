# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive turtle1 by the keys of a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
import os
import select
import sys
import termios
import threading
import tty

from geometry_msgs.msg import Twist
from node_program import refuse, run_node, spin
from rclpy.action import ActionClient
from rclpy.action.client import ClientGoalHandle
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future
from turtlesim.action import RotateAbsolute

from turtlesim_programs.turtle_topics import QOS

HELP = """\
The arrow keys move turtle1.
g, t, r, e, d, c, v and b turn it to a direction: they lie round f as directions do.
f ends such a turn, q this program."""

# The last byte of what an arrow sends, and how far it goes forward and turns.
MOVES = {b'A': (1.0, 0.0), b'B': (-1.0, 0.0), b'C': (0.0, -1.0), b'D': (0.0, 1.0)}
# The keys lie round f as the directions do.
DIRECTIONS = {
    **{b'g': 0.0, b't': 0.7854, b'r': 1.5708, b'e': 2.3562},
    **{b'd': 3.1416, b'c': -2.3562, b'v': -1.5708, b'b': -0.7854},
}
CANCEL, CLOSED = b'f', b''
ENDINGS = (b'q', CLOSED)
PERIOD_SEC = 0.02  # keys are read so often


class TeleopTurtle(Node):
    """Publishes the commands of keys, and sends their goals."""

    def __init__(self) -> None:
        super().__init__('teleop_turtle')
        self.declare_parameter('scale_angular', 2.0)
        self.declare_parameter('scale_linear', 2.0)
        self._commands = self.create_publisher(Twist, 'turtle1/cmd_vel', QOS)
        self._rotations = ActionClient(self, RotateAbsolute, 'turtle1/rotate_absolute')
        self._goal: ClientGoalHandle | None = None

    def press(self, key: bytes) -> None:
        """Do what a key means; of others nothing comes."""
        if key in MOVES:
            self._move(*MOVES[key])
        elif key in DIRECTIONS:
            goal = RotateAbsolute.Goal(theta=DIRECTIONS[key])
            self._rotations.send_goal_async(goal).add_done_callback(self._on_answer)
        elif key == CANCEL and self._goal:
            self._goal.cancel_goal_async()

    def _move(self, forward: float, turn: float) -> None:
        twist = Twist()
        twist.linear.x = self.get_parameter('scale_linear').value * forward
        twist.angular.z = self.get_parameter('scale_angular').value * turn
        self._commands.publish(twist)

    def _on_answer(self, answer: Future[ClientGoalHandle]) -> None:
        self._goal = answer.result()


@contextmanager
def keys_at_once(terminal: int) -> Iterator[None]:
    """Let every key through at once and unseen; put the terminal back afterwards."""
    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        yield
    finally:
        with suppress(termios.error):  # the terminal may be closed
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def use(node: TeleopTurtle, stop: threading.Event) -> int:
    """Read keys until one ends it, or a signal."""
    terminal = sys.stdin.fileno()

    def on_time() -> None:
        for key in _pressed(terminal):
            if key in ENDINGS:
                stop.set()
            else:
                node.press(key)

    node.create_timer(PERIOD_SEC, on_time, clock=Clock(clock_type=ClockType.STEADY_TIME))
    with keys_at_once(terminal):
        print(HELP, flush=True)
        return spin(node, stop)


def _pressed(terminal: int) -> list[bytes]:
    """Return what was pressed, byte by byte; what a closed terminal gives, if it is closed."""
    if not select.select([terminal], [], [], 0.0)[0]:
        return []
    try:
        pressed = os.read(terminal, 1024)
    except OSError:
        pressed = CLOSED
    return [bytes([key]) for key in pressed] or [CLOSED]


def main(argv: list[str] | None = None) -> int:
    if not sys.stdin.isatty():
        return refuse('turtle_teleop_key: needs a terminal to read keys from; run it in one')
    return run_node(lambda _: TeleopTurtle(), sys.argv if argv is None else argv, use)


if __name__ == '__main__':
    sys.exit(main())
