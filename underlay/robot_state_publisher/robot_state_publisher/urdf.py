# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The joints of a robot, read from its URDF (http://wiki.ros.org/urdf/XML)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
import math
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from tf2_py.motions import compose, Motion, NO_ROTATION, of_angles, Vector

_TURNING = ('revolute', 'continuous')
_SLIDING = 'prismatic'
_STANDING = ('fixed', 'floating', 'planar')
_LIMITED = ('revolute', _SLIDING)
# Of what stands it is not read, as by upstream's parser: files of real robots have 0 0 0 there.
_NO_AXIS = (0.0, 0.0, 0.0)
_XACRO = '{http://www.ros.org/wiki/xacro}'


class UrdfError(ValueError):
    """A text is no URDF of a robot; the message is one line."""


@dataclass(frozen=True)
class Mimic:
    """A joint goes where another one is: multiplier times its position, plus the offset."""

    joint: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Joint:
    """
    What holds one link to another.

    :param origin: where the child's frame is in the parent's, while the position is 0.
    :param axis: in the child's frame, of length 1; of no joint that stands.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Motion
    axis: Vector
    mimic: Mimic | None

    @property
    def moves(self) -> bool:
        """Tell whether a position moves it; a planar joint stands, as with upstream's KDL."""
        return self.kind not in _STANDING

    def motion(self, position: float) -> Motion:
        """Return where the child's frame is in the parent's, at so many radians or metres."""
        if not self.moves:
            return self.origin
        x, y, z = self.axis
        if self.kind == _SLIDING:
            slide = (x * position, y * position, z * position)
            return compose(self.origin, Motion(NO_ROTATION, slide))
        # The sine of infinity is no number, as upstream's; Python raises.
        half = 0.5 * position if math.isfinite(position) else math.nan
        sine = math.sin(half)
        turn = (x * sine, y * sine, z * sine, math.cos(half))
        return compose(self.origin, Motion(turn, (0.0, 0.0, 0.0)))


def read_joints(text: str) -> list[Joint]:
    """
    Return the joints of a robot, sorted by name.

    :raises UrdfError: where upstream's parser gives up.
    """
    try:
        robot = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError as error:
        raise UrdfError(f'this is no XML: {error}') from None
    if robot.tag != 'robot':
        raise UrdfError(f'the outermost element is <{robot.tag}>, expected is <robot>')
    for element in robot.iter():
        if element.tag.startswith(_XACRO):
            name = element.tag.removeprefix(_XACRO)
            raise UrdfError(f'<xacro:{name}> is no URDF: let the command xacro make one of it')
    _attribute(robot, 'name', 'the robot')
    links = [_attribute(link, 'name', 'a link') for link in robot.iterfind('link')]
    joints = [_joint(element) for element in robot.iterfind('joint')]
    _check_unique('link', links)
    _check_unique('joint', [joint.name for joint in joints])
    _check_tree(dict.fromkeys(links), joints)  # in their order, and found at once
    return sorted(joints, key=lambda joint: joint.name)


def _check_unique(what: str, names: Sequence[str]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise UrdfError(f"there are two {what}s '{name}'; each needs a name of its own")


def _check_tree(links: Collection[str], joints: Sequence[Joint]) -> None:
    if not links:
        raise UrdfError('it has no link')
    parents: dict[str, str] = {}
    for joint in joints:
        for link in (joint.parent, joint.child):
            if link not in links:
                raise UrdfError(f"joint '{joint.name}': there is no link '{link}'")
        if joint.child in parents:
            raise UrdfError(f"link '{joint.child}' is the child of two joints")
        parents[joint.child] = joint.parent
    roots = [link for link in links if link not in parents]
    if len(roots) > 1:
        raise UrdfError(f"'{roots[0]}' and '{roots[1]}' are no children of a joint; one may be")
    for link in links:
        seen = {link}
        while link in parents:
            link = parents[link]
            if link in seen:
                raise UrdfError(f"link '{link}' is its own ancestor")
            seen.add(link)


def _joint(element: Element) -> Joint:
    name = _attribute(element, 'name', 'a joint')
    where = f"joint '{name}'"
    kind = _attribute(element, 'type', where)
    if kind not in (*_TURNING, _SLIDING, *_STANDING):
        allowed = ', '.join((*_TURNING, _SLIDING, *_STANDING))
        raise UrdfError(f"{where}: the type '{kind}' is unknown; there are {allowed}")
    if kind in _LIMITED and element.find('limit') is None:
        raise UrdfError(f'{where}: a {kind} joint needs a <limit>')
    origin = element.find('origin')
    angles = _vector(origin, 'rpy', where)
    mimic = element.find('mimic')
    return Joint(
        name,
        kind,
        _attribute(_child(element, 'parent', where), 'link', f'{where}: <parent>'),
        _attribute(_child(element, 'child', where), 'link', f'{where}: <child>'),
        Motion(of_angles(*angles), _vector(origin, 'xyz', where)),
        _NO_AXIS if kind in _STANDING else _axis(element, where),
        None if mimic is None else _mimic(mimic, where),
    )


def _axis(element: Element, where: str) -> Vector:
    x, y, z = _vector(element.find('axis'), 'xyz', where, (1.0, 0.0, 0.0))
    length = math.hypot(x, y, z)
    if length == 0.0:
        raise UrdfError(f'{where}: <axis xyz="0 0 0"> has no direction')
    return (x / length, y / length, z / length)


def _mimic(element: Element, where: str) -> Mimic:
    return Mimic(
        _attribute(element, 'joint', f'{where}: <mimic>'),
        _number(element.get('multiplier', '1'), where),
        _number(element.get('offset', '0'), where),
    )


def _child(element: Element, tag: str, where: str) -> Element:
    child = element.find(tag)
    if child is None:
        raise UrdfError(f'{where}: <{tag}> is missing')
    return child


def _attribute(element: Element, name: str, where: str) -> str:
    value = element.get(name)
    if not value:
        raise UrdfError(f'{where}: the attribute {name} is missing')
    return value


def _vector(
    element: Element | None, name: str, where: str, default: Vector = (0.0, 0.0, 0.0)
) -> Vector:
    text = None if element is None else element.get(name)
    if text is None:
        return default
    words = text.split()
    if len(words) != 3:
        raise UrdfError(f'{where}: {name}="{text}" has to be three numbers')
    x, y, z = (_number(word, where) for word in words)
    return (x, y, z)


def _number(text: str, where: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise UrdfError(f"{where}: '{text}' is no number")
    return number
