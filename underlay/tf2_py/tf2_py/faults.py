# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a transform that somebody sends, in the words of tf2."""

from __future__ import annotations

from collections.abc import Iterable
import math

from tf2_py.motions import Motion

_TOLERANCE = 10e-3  # of the square of a quaternion's length


def faults_of(parent: str, child: str, motion: Motion, authority: str) -> list[str]:
    """Return a line for each reason to ignore a transform."""
    faults = []
    if child == parent:
        faults.append(
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id '
            f'and  child_frame_id "{child}" because they are the same'
        )
    if not child:
        faults.append(
            f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because '
            'child_frame_id not set '
        )
    if not parent:
        faults.append(
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority '
            f'"{authority}" because frame_id not set'
        )
    rotation, translation = motion
    if any(map(math.isnan, (*translation, *rotation))):
        faults.append(
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority '
            f'"{authority}" because of a nan value in the transform ({_numbers(translation)}) '
            f'({_numbers(rotation)})'
        )
    if not abs(sum(component**2 for component in rotation) - 1.0) < _TOLERANCE:
        faults.append(
            f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from '
            f'authority "{authority}" because of an invalid quaternion in the transform '
            f'({_numbers(rotation)})'
        )
    return faults


def _numbers(values: Iterable[float]) -> str:
    return ' '.join(f'{value:f}' for value in values)
