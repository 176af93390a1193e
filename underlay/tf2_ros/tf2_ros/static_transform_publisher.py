# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Publish one transform that holds at all times, until Ctrl-C."""

from __future__ import annotations

from dataclasses import dataclass
import random
import string
import sys
from typing import Any

from geometry_msgs.msg import TransformStamped
from node_program import own_words, run_node
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from tf2_py.motions import of_angles, Quaternion, Vector

from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster

_USAGE = """\
usage: static_transform_publisher [--x X] [--y Y] [--z Z] [--qx QX] [--qy QY] [--qz QZ] [--qw QW] \
[--roll ROLL] [--pitch PITCH] [--yaw YAW] --frame-id FRAME_ID --child-frame-id CHILD_FRAME_ID

Publishes a transform that never changes, for whoever listens now or later.

which must be given:
  --frame-id FRAME_ID              the frame that is known
  --child-frame-id CHILD_FRAME_ID  the one that is placed in it

where it is, in metres; 0 where nothing is said:
  --x X, --y Y, --z Z

how it is turned, in one of two ways; not at all where nothing is said:
  --roll ROLL, --pitch PITCH, --yaw YAW     angles about x, y and z, in radians
  --qx QX, --qy QY, --qz QZ, --qw QW        a quaternion
"""
_TRANSLATION = ('x', 'y', 'z')
_ANGLES = ('roll', 'pitch', 'yaw')
_QUATERNION = ('qx', 'qy', 'qz', 'qw')
_FRAMES = ('frame-id', 'child-frame-id')
_OPTIONS = frozenset({*_TRANSLATION, *_ANGLES, *_QUATERNION, *_FRAMES})
_OLD_STYLE = {
    8: (*_TRANSLATION, *reversed(_ANGLES), *_FRAMES),
    9: (*_TRANSLATION, *_QUATERNION, *_FRAMES),
}
_UNNAMED = RcutilsLogger()  # upstream logs these without a name


@dataclass(frozen=True)
class Fixed:
    """What is published."""

    frame_id: str
    child_frame_id: str
    translation: Vector
    rotation: Quaternion

    def __str__(self) -> str:
        translation, rotation = (
            ', '.join(f"'{number:f}'" for number in numbers)
            for numbers in (self.translation, self.rotation)
        )
        return (
            f'translation: ({translation})\nrotation: ({rotation})\n'
            f"from '{self.frame_id}' to '{self.child_frame_id}'"
        )


class StaticTransformPublisher(Node):
    """Sends its transform once, for those who come later too; parameters tell what it is."""

    def __init__(self, fixed: Fixed) -> None:
        values = {
            **_named('translation', fixed.translation),
            **_named('rotation', fixed.rotation),
            'frame_id': fixed.frame_id,
            'child_frame_id': fixed.child_frame_id,
        }
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        super().__init__(_unique_name(), parameter_overrides=overrides)
        for name, value in values.items():
            self.declare_parameter(name, value, ParameterDescriptor(read_only=True))
        message = TransformStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id, message.child_frame_id = fixed.frame_id, fixed.child_frame_id
        to, turn = message.transform.translation, message.transform.rotation
        to.x, to.y, to.z = fixed.translation
        turn.x, turn.y, turn.z, turn.w = fixed.rotation
        self._broadcaster = StaticTransformBroadcaster(self)
        self._broadcaster.sendTransform(message)
        self.get_logger().info(f'Spinning until stopped - publishing transform\n{fixed}')


def main() -> int:
    """Publish until Ctrl-C; 1: the arguments are wrong."""
    words = own_words(sys.argv)
    if {'-h', '--help'} & {*words}:
        print(_USAGE, end='')
        return 0
    try:
        fixed = parse(words)
    except ValueError as error:
        _UNNAMED.error(f'error parsing command line arguments: {error}')
        print(_USAGE, end='')
        return 1
    if fixed.frame_id == fixed.child_frame_id:
        _UNNAMED.error(
            f"cannot publish static transform from '{fixed.frame_id}' to "
            f"'{fixed.child_frame_id}', exiting"
        )
        return 1
    return run_node(lambda _: StaticTransformPublisher(fixed), sys.argv)


def parse(words: list[str]) -> Fixed:
    """Read options, or the arguments in fixed places that were before them.

    :raises ValueError: what is wrong, in upstream's words.
    """
    given, rest = _options(words)
    if given.keys() & _ANGLES and given.keys() & _QUATERNION:
        raise ValueError('Cannot specify both quaternion and Euler rotations')
    if len(rest) in _OLD_STYLE:
        _UNNAMED.warning('Old-style arguments are deprecated; see --help for new-style arguments')
        if given:
            raise ValueError('Cannot specify both new-style (flags) and old-style (arguments)')
        names = _OLD_STYLE[len(rest)]
        given = {name: _value(name, name, text) for name, text in zip(names, rest, strict=True)}
    elif rest:
        raise ValueError('Extra unparsed arguments on command-line')
    if not given.get('frame-id'):
        raise ValueError('Frame id must not be empty')
    if not given.get('child-frame-id'):
        raise ValueError('Child frame id must not be empty')
    x, y, z, roll, pitch, yaw, qx, qy, qz = (
        given.get(name, 0.0) for name in (*_TRANSLATION, *_ANGLES, *_QUATERNION[:3])
    )
    turned = bool(given.keys() & _ANGLES)
    rotation = of_angles(roll, pitch, yaw) if turned else (qx, qy, qz, given.get('qw', 1.0))
    return Fixed(given['frame-id'], given['child-frame-id'], (x, y, z), rotation)


def _options(words: list[str]) -> tuple[dict[str, Any], list[str]]:
    """Return the values of options, and the words that are none."""
    given: dict[str, Any] = {}
    rest = []
    left = iter(words)
    for word in left:
        name = word.removeprefix('--')
        if name == word or name not in _OPTIONS:
            rest.append(word)
            continue
        text = next(left, None)
        if text is None:
            raise ValueError(f'Not enough arguments for {word}')
        given[name] = _value(word, name, text)
    return given, rest


def _value(written: str, name: str, text: str) -> str | float:
    if name in _FRAMES:
        return text
    try:
        return float(text)
    except ValueError:
        raise ValueError(f'Failed to parse {written} argument as float') from None


def _named(group: str, numbers: tuple[float, ...]) -> dict[str, float]:
    return {f'{group}.{axis}': number for axis, number in zip('xyzw', numbers, strict=False)}


def _unique_name() -> str:
    letters = string.digits + string.ascii_letters
    return f'static_transform_publisher_{"".join(random.choices(letters, k=16))}'


if __name__ == '__main__':
    sys.exit(main())
