# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Joints that follow others: which one each follows in the end, and how."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from joint_state_publisher.description import DescriptionError


class MimicCycleError(DescriptionError):
    """Joints follow each other in a circle."""


@dataclass(frozen=True)
class Follower:
    """A joint goes where a free one is: factor times its position, plus the offset."""

    leader: str
    factor: float
    offset: float


def followers(
    dependent: Mapping[str, Mapping[str, Any]], free: Collection[str]
) -> dict[str, Follower]:
    """
    Return whom each dependent joint follows.

    :param dependent: of each the 'parent', and 'factor' and 'offset' where they are not 1 and 0.
    :param free: the joints that follow none.
    :raises MimicCycleError: one follows itself.
    :raises DescriptionError: one follows a joint that does not move, or does not exist.
    """
    return {name: _follow(name, dependent, free) for name in dependent}


def _follow(
    name: str, dependent: Mapping[str, Mapping[str, Any]], free: Collection[str]
) -> Follower:
    factor, offset = 1.0, 0.0
    chain, joint = [name], name
    while joint in dependent:
        mimic = dependent[joint]
        offset += factor * mimic.get('offset', 0.0)
        factor *= mimic.get('factor', 1.0)
        follower, joint = joint, mimic['parent']
        if joint in chain:
            raise MimicCycleError(f'Found an infinite recursive mimic chain: {[*chain, joint]}')
        if joint not in free and joint not in dependent:
            raise DescriptionError(
                f'joint "{follower}" mimics "{joint}", which is no joint of the robot that moves'
            )
        chain.append(joint)
    return Follower(joint, factor, offset)
