# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a description of a robot says of its joints that move: URDF, SDF or COLLADA."""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

_FULL_TURN = (-math.pi, math.pi)
_URDF_WITHOUT_POSITION = ('fixed', 'floating', 'planar')
_SDF_WITHOUT_POSITION = ('fixed', 'gearbox', 'revolute2', 'ball', 'screw', 'universal')
_COLLADA_FROM = (1, 5, 0)
_XACRO = '{http://www.ros.org/wiki/xacro}'


class DescriptionError(ValueError):
    """A text describes no robot whose joints can be moved; the message is one line."""


@dataclass(frozen=True)
class Joint:
    """
    A joint that moves.

    :param lower: in rad or m, as upper.
    :param turns_on: it has no ends; after one turn it is where it was.
    :param mimic: where it follows another: that one's name as 'parent', and 'factor' and 'offset'
        where they are given.
    """

    name: str
    lower: float
    upper: float
    turns_on: bool = False
    mimic: dict[str, Any] | None = None


def read_joints(text: str, *, use_smallest_limits: bool = True) -> list[Joint]:
    """
    Return the joints that move, in the order of the description.

    :param use_smallest_limits: whether the soft limits of a safety controller count as well.
    :raises DescriptionError: a joint lacks what it needs, or the text is of another kind.
    """
    try:
        root = ElementTree.fromstring(text.strip())
    except ElementTree.ParseError as error:
        raise DescriptionError(f'this is no XML: {error}') from None
    if root.tag == 'sdf':
        return _read_sdf(root)
    if _local(root) == 'COLLADA':
        return _read_collada(root)
    return _read_urdf(root, use_smallest_limits)


def _read_urdf(root: Element, use_smallest_limits: bool) -> list[Joint]:
    robot = next(root.iter('robot'), None)
    if robot is None:
        raise DescriptionError('URDF must have a "robot" tag')
    for element in robot.iter():
        if element.tag.startswith(_XACRO):
            name = element.tag.removeprefix(_XACRO)
            raise DescriptionError(
                f'<xacro:{name}> is no URDF: let the command xacro make one of it'
            )
    joints = []
    for element in robot.findall('joint'):
        kind = element.get('type', '')
        if kind not in _URDF_WITHOUT_POSITION:
            joints.append(_urdf_joint(element, kind, use_smallest_limits))
    return joints


def _urdf_joint(element: Element, kind: str, use_smallest_limits: bool) -> Joint:
    name = element.get('name', '')
    lower, upper = _FULL_TURN
    if kind != 'continuous':
        limit = _limit(element.find('.//limit'), name, kind)
        lower = _limit_number(limit.get('lower'), 'lower', name, kind)
        upper = _limit_number(limit.get('upper'), 'upper', name, kind)
    safety = element.findall('.//safety_controller')
    if use_smallest_limits and len(safety) == 1:
        lower = max(lower, _number(safety[0], 'soft_lower_limit', name, lower))
        upper = min(upper, _number(safety[0], 'soft_upper_limit', name, upper))
    mimics = element.findall('.//mimic')
    mimic = _mimic(mimics[0], name) if len(mimics) == 1 else None
    return Joint(name, lower, upper, kind == 'continuous', mimic)


def _mimic(element: Element, name: str) -> dict[str, Any]:
    mimic: dict[str, Any] = {'parent': element.get('joint', '')}
    for attribute, key in (('multiplier', 'factor'), ('offset', 'offset')):
        if element.get(attribute) is not None:
            mimic[key] = _number(element, attribute, name, 0.0)
    return mimic


def _number(element: Element, attribute: str, name: str, default: float) -> float:
    text = element.get(attribute)
    if text is None:
        return default
    try:
        return float(text)
    except ValueError:
        raise DescriptionError(
            f'"{attribute}" must be a float for joint "{name}", not "{text}"'
        ) from None


def _limit(element: Element | None, name: str, kind: str) -> Element:
    if element is None:
        raise DescriptionError(f'Limits must be specified for joint "{name}" of type "{kind}"')
    return element


def _limit_number(text: str | None, limit: str, name: str, kind: str) -> float:
    where = f'for joint "{name}" of type "{kind}"'
    if text is None:
        raise DescriptionError(f'"{limit}" limit must be specified {where}')
    try:
        return float(text)
    except ValueError:
        raise DescriptionError(f'"{limit}" limit must be a float {where}') from None


def _limit_text(limit: Element, tag: str) -> str | None:
    """Return what stands in an element, in which it may be deeper; None where there is none."""
    element = limit.find(f'.//{{*}}{tag}')
    return None if element is None else element.text or ''


def _read_sdf(root: Element) -> list[Joint]:
    model = next(root.iter('model'), None)
    if model is None:
        raise DescriptionError('SDF must have a "model" tag')
    joints = []
    for element in model.findall('joint'):
        kind, name = element.get('type', ''), element.get('name', '')
        if kind in _SDF_WITHOUT_POSITION:
            continue
        if kind == 'continuous':
            joints.append(Joint(name, *_FULL_TURN, turns_on=True))
            continue
        limit = _limit(element.find('.//limit'), name, kind)
        lower = _limit_number(_limit_text(limit, 'lower'), 'lower', name, kind)
        upper = _limit_number(_limit_text(limit, 'upper'), 'upper', name, kind)
        joints.append(Joint(name, lower, upper))
    return joints


def _read_collada(root: Element) -> list[Joint]:
    """Read the revolute joints, whose limits are in degrees; equal ones are of a fixed joint."""
    _check_collada_version(root.get('version'))
    model = root.find('.//{*}kinematics_model')
    if model is None:
        raise DescriptionError('COLLADA must have a "kinematics_model" tag')
    technique = model.find('.//{*}technique_common')
    if technique is None:
        raise DescriptionError('COLLADA must have a "technique_common" tag')
    joints = []
    for element in technique.findall('{*}joint'):
        name, revolute = element.get('name', ''), element.find('.//{*}revolute')
        if revolute is None:
            continue
        limit = _limit(revolute.find('.//{*}limits'), name, 'revolute')
        lower = _limit_number(_limit_text(limit, 'min'), 'min', name, 'revolute')
        upper = _limit_number(_limit_text(limit, 'max'), 'max', name, 'revolute')
        if lower != upper:
            joints.append(Joint(name, math.radians(lower), math.radians(upper)))
    return joints


def _check_collada_version(text: str | None) -> None:
    if text is None:
        raise DescriptionError('COLLADA must have a version tag')
    try:
        version = tuple(int(word) for word in text.split('.'))
    except ValueError:
        raise DescriptionError(f'"{text}" is no version of COLLADA') from None
    if version + (0,) * (3 - len(version)) < _COLLADA_FROM:
        raise DescriptionError('COLLADA must be at least version 1.5.0')


def _local(element: Element) -> str:
    return element.tag.rpartition('}')[2]
