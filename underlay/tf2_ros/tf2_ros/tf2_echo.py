# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Print where a frame is in another, again and again."""

from __future__ import annotations

import argparse
from collections.abc import Callable
import math
import re
import sys
from typing import NoReturn

from geometry_msgs.msg import TransformStamped
from node_program import own_words, run_node
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.time import Time
from tf2_py import TransformException
from tf2_py.motions import matrix_of, Vector

from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener

_USAGE = """\
Usage: tf2_echo source_frame target_frame [echo_rate]

Prints where target_frame is in source_frame: what takes a point that is told in
target_frame into source_frame.

  echo_rate                  how often a second (default: 1)
  -r, --rate RATE            the same
  -p, --precision PRECISION  digits after the point (default: 3)
  -l, --limit LIMIT          end after so many transforms
  -h, --help                 this text
"""
_NUMBER = re.compile(r'\s*[+-]?(\d|\.\d|inf|nan)', re.IGNORECASE)


def main() -> int:
    """Echo until Ctrl-C, or as often as is asked for."""
    args = _parse(own_words(sys.argv))
    return run_node(lambda stop: Echo(args, stop.set), sys.argv)


class Echo(Node):
    """Says what it waits for, then prints the transform at each tick."""

    def __init__(self, args: argparse.Namespace, finish: Callable[[], None]) -> None:
        super().__init__('tf2_echo')
        self._source, self._target = args.source, args.target
        self._precision = args.precision
        self._left = args.limit
        self._finish = finish
        self._was_there = False
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._on_tick()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0 / args.rate, self._on_tick, clock=steady)

    def _on_tick(self) -> None:
        frames = (self._source, self._target)
        if not self._was_there:
            possible, why = self._buffer.can_transform_core(*frames, Time())
            if not possible:
                self.get_logger().info(
                    f'Waiting for transform {self._source} ->  {self._target}: {why}',
                    throttle_duration_sec=1.0,
                )
                return
            self._was_there = True
        try:
            found = self._buffer.lookup_transform_core(*frames, Time())
        except TransformException as error:
            now = self.get_clock().now().nanoseconds * 1e-9
            said = f'Failure at {now:.{self._precision}f}\nException thrown:{error}\n'
            said += f'The current list of frames is:\n{self._buffer.all_frames_as_string()}'
        else:
            said = describe(found, self._precision)
        print(said, flush=True)
        if self._left is not None:
            self._left -= 1
            if not self._left:
                self._finish()


def describe(found: TransformStamped, precision: int) -> str:
    """Write a transform in each way in which people think of a rotation."""

    def row(*numbers: float) -> str:
        return ', '.join(f'{number:.{precision}f}' for number in numbers)

    stamp, to, turn = found.header.stamp, found.transform.translation, found.transform.rotation
    matrix = matrix_of((turn.x, turn.y, turn.z, turn.w))
    angles = roll_pitch_yaw(matrix)
    homogeneous = zip(
        (*matrix, (0.0, 0.0, 0.0)),
        (to.x, to.y, to.z, 1.0),
        strict=True,
    )
    return '\n'.join(
        [
            f'At time {stamp.sec}.{stamp.nanosec}',
            f'- Translation: [{row(to.x, to.y, to.z)}]',
            f'- Rotation: in Quaternion (xyzw) [{row(turn.x, turn.y, turn.z, turn.w)}]',
            f'- Rotation: in RPY (radian) [{row(*angles)}]',
            f'- Rotation: in RPY (degree) [{row(*map(math.degrees, angles))}]',
            '- Matrix:',
            *(
                ''.join(f' {number:6.{precision}f}' for number in (*numbers, last))
                for numbers, last in homogeneous
            ),
        ]
    )


def roll_pitch_yaw(matrix: tuple[Vector, Vector, Vector]) -> tuple[float, float, float]:
    """Return the angles about x, y and z; straight up or down there is no yaw."""
    (a, _, _), (b, _, _), (c, d, e) = matrix
    if abs(c) >= 1.0:
        return math.atan2(d, e), math.copysign(0.5 * math.pi, -c), 0.0
    return math.atan2(d, e), -math.asin(c), math.atan2(b, a)


class _Parser(argparse.ArgumentParser):
    """Says what is expected as upstream does."""

    def error(self, message: str) -> NoReturn:
        print(_USAGE, end='')
        print(f'tf2_echo: {message}', file=sys.stderr)
        sys.exit(1)

    def format_help(self) -> str:
        return _USAGE


def _parse(words: list[str]) -> argparse.Namespace:
    parser = _Parser(prog='tf2_echo')
    parser.add_argument('source', metavar='source_frame')
    parser.add_argument('target', metavar='target_frame')
    parser.add_argument('echo_rate', nargs='?', default='1')
    parser.add_argument('-r', '--rate')
    parser.add_argument('-p', '--precision', type=_positive, default=3)
    parser.add_argument('-l', '--limit', type=_positive)
    args = parser.parse_args(words)
    args.rate = _rate(args.rate or args.echo_rate)
    return args


def _positive(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"'{text}' is refused: it must be a whole number from 1")
    return int(text)


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        print(
            f"Failed to convert rate argument '{text}' to a floating-point number",
            file=sys.stderr,
        )
        sys.exit(3 if _NUMBER.match(text) else 2)  # 3: more stands behind a number
    if not 0.0 < rate < math.inf:
        print(f"tf2_echo: rate '{text}' is refused: it must be more than 0", file=sys.stderr)
        sys.exit(2)
    return rate


if __name__ == '__main__':
    sys.exit(main())
