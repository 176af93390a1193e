# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Drive the Husky by the keys of a terminal."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
import os
import select
import signal
import sys
import termios
import time
import tty
from typing import Any

from husky_runtime.command_line import BAD_INPUT
from husky_runtime.executor import spin
from husky_runtime.node_parser import NodeParser
from husky_runtime.parameters import declare_settings
from husky_runtime.settings import names_of, refuse_unknown, setting, settings_of
from husky_runtime.start import SignalsHeldBack
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.utilities import remove_ros_args

from husky_driver.keys import HELP, Keyboard, MAX_SPEED_M_S, MAX_TURN_RAD_S, split_keys
from husky_driver.motion import Command, STOP
from husky_driver.ros.commands import Commands
from husky_driver.ros.missing import in_another_namespace
from husky_driver.ros.settings import INTERFACES, refuse

PERIOD_SEC = 0.05
HINT_AFTER_SEC = 2.0
DELIVERY_SEC = 0.5  # how long the last command, a stop, may take to arrive
ENDINGS = ('\x03', '\x1b', '')  # Ctrl-C, Esc, and a terminal that was closed


@dataclass(frozen=True)
class TeleopSettings:
    """What `--ros-args -p name:=value` can set."""

    speed: float = setting(0.5, 'forward speed of a key, m/s', 0.01, MAX_SPEED_M_S)
    turn: float = setting(1.0, 'yaw rate of a key, rad/s', 0.01, MAX_TURN_RAD_S)
    interface: str = setting(
        'lab',
        'topics of the robot: lab, or clearpath, those of a real A200',
        choices=INTERFACES,
    )


class Teleop(Node):
    """Publishes the commands of the keys, and zero without one; `finished` when it is over."""

    def __init__(self, terminal: int, **arguments: Any) -> None:
        arguments.setdefault('automatically_declare_parameters_from_overrides', True)
        super().__init__('teleop', **arguments)
        refuse_unknown(self.get_parameters_by_prefix(''), names_of(TeleopSettings))
        settings = declare_settings(self, TeleopSettings, refuse)
        self.finished: Future[None] = Future()
        self.keyboard = Keyboard(speed_m_s=settings.speed, turn_rad_s=settings.turn)
        self._terminal = terminal
        self._last = STOP
        self._commands = Commands(self, INTERFACES[settings.interface])
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(PERIOD_SEC, self._on_tick, clock=steady)
        self._hint = self.create_timer(HINT_AFTER_SEC, self._on_hint, clock=steady)

    def _on_tick(self) -> None:
        now = time.monotonic()
        while not self.finished.done() and select.select([self._terminal], [], [], 0.0)[0]:
            self._read(now)
        command = STOP if self.finished.done() else self.keyboard.command(now)
        if command != STOP or self._last != STOP:
            self._publish(command)

    def _on_hint(self) -> None:
        self._hint.cancel()
        if not self._commands.publisher.get_subscription_count():
            topic, domain = self._commands.publisher.topic_name, self.context.get_domain_id()
            why = in_another_namespace(self, topic, self.count_subscribers) or (
                f'is the simulator running, with ROS_DOMAIN_ID={domain} as here? '
                '`ros2 launch husky_sim husky_playpen.launch.py`'
            )
            print(f'\rnobody takes {topic} yet: {why}', file=sys.stderr)

    def _read(self, now: float) -> None:
        try:
            text = os.read(self._terminal, 1024).decode(errors='replace')
        except OSError:  # the terminal was closed
            text = ''
        for key in split_keys(text) or ['']:
            if key in ENDINGS:
                self.end()
                return
            self.keyboard.press(key, now)
        self._show()

    def _show(self) -> None:
        speed, turn = self.keyboard.speed_m_s, self.keyboard.turn_rad_s
        sys.stdout.write(f'\r{speed:.2f} m/s  {turn:.2f} rad/s   ')
        sys.stdout.flush()

    def _publish(self, command: Command) -> None:
        self._last = command
        self._commands.publish(*command, self.get_clock().now().seconds_nanoseconds())

    def deliver(self) -> None:
        """Wait until the last command has arrived: a destroyed node sends nothing more."""
        self._commands.publisher.wait_for_all_acked(Duration(seconds=DELIVERY_SEC))

    def end(self) -> None:
        """Stop the robot and finish."""
        if not self.finished.done():
            self._publish(STOP)
            self.finished.set_result(None)


@contextmanager
def raw_terminal(terminal: int) -> Iterator[None]:
    """Let every key through at once; put the terminal back afterwards."""

    def on_resume(*_: object) -> None:
        with suppress(termios.error):  # the terminal may be closed
            tty.setcbreak(terminal)

    before = termios.tcgetattr(terminal)
    # After Ctrl-Z the shell puts back what it had before, and leaves that so with `fg`.
    handler = signal.signal(signal.SIGCONT, on_resume)
    try:
        tty.setcbreak(terminal)
        yield
    finally:
        signal.signal(signal.SIGCONT, handler)
        with suppress(termios.error):  # the terminal may be closed
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def main(args: Sequence[str] | None = None) -> int:
    argv = list(sys.argv if args is None else args)
    parser = NodeParser('teleop', __doc__, settings_of(TeleopSettings), more=HELP)
    parser.parse_args(remove_ros_args(argv)[1:])
    if not sys.stdin.isatty():
        print('teleop: needs a terminal to read keys from; run it in one', file=sys.stderr)
        return BAD_INPUT
    try:
        with SignalsHeldBack():
            rclpy.init(args=argv, signal_handler_options=SignalHandlerOptions.NO)
            node = Teleop(sys.stdin.fileno())
    except KeyboardInterrupt:
        rclpy.try_shutdown()
        return 0
    except Exception as error:  # rcl raises many types for wrong arguments
        print(f'teleop: {" ".join(str(error).split())}', file=sys.stderr)
        rclpy.try_shutdown()
        return BAD_INPUT
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: node.end())
    print(HELP)
    try:
        with raw_terminal(sys.stdin.fileno()):
            spin(node, until=node.finished)
    finally:
        node.deliver()
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
