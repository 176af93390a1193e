# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The transforms that come while it is listened to them, and frames that are sent twice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
import difflib
import itertools
import math
from typing import Any

from ros2_diagnosis.finding import Finding

TRANSFORMS, FIXED = '/tf', '/tf_static'
_ALIKE = 0.8  # of difflib: base_lnk and base_link are, base_footprint and base_link are not
_APART_SEC = 60.0  # no transform is sent so late, or so far ahead
_BEGINNING_SEC = 1.0  # of a simulation, in which a stamp of 0 may be right


@dataclass
class Heard:
    """What comes while it is listened to.

    :param times: those that the clock has told meanwhile, in seconds.
    :param links: the parent and the stamp of each transform on /tf, by its child.
    :param numbers: those that the publishers of these messages have given them, by the child.
    :param places: where each child was.
    :param refused: why listeners ignore a child, as far as they do.
    :param fixed: the parents of each frame of /tf_static.
    """

    times: list[float] = field(default_factory=list)
    links: dict[str, list[tuple[str, float]]] = field(default_factory=dict)
    numbers: dict[str, list[int]] = field(default_factory=dict)
    places: dict[str, set[str]] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    fixed: dict[str, set[str]] = field(default_factory=dict)

    def on_clock(self, msg: Any) -> None:
        self.times.append(seconds(msg.clock))

    def on_transforms(self, msg: Any, info: Any) -> None:
        accepted = self._accepted(msg)
        for child, parent, each in accepted:
            self.links.setdefault(child, []).append((parent, seconds(each.header.stamp)))
            self.places.setdefault(child, set()).add(str(each.transform))
        for child in {child for child, _, _ in accepted}:
            self.numbers.setdefault(child, []).append(info['publication_sequence_number'])

    def on_fixed(self, msg: Any) -> None:
        for child, parent, _ in self._accepted(msg):
            self.fixed.setdefault(child, set()).add(parent)

    def _accepted(self, msg: Any) -> list[tuple[str, str, Any]]:
        """Return child, parent and all of each transform that tf2 takes; a first / counts not."""
        found = []
        for each in msg.transforms:
            child, parent = (
                name.removeprefix('/') for name in (each.child_frame_id, each.header.frame_id)
            )
            if why := _why_refused(child, parent, each.transform):
                self.refused[child] = why
            else:
                found.append((child, parent, each))
        return found

    def is_timely(self, stamp: float) -> bool:
        first, last = min(self.times), max(self.times)
        if stamp == 0.0:
            return first < _BEGINNING_SEC
        apart = _APART_SEC + last - first  # simulated time may pass a hundred times as fast
        return first - apart < stamp < last + apart

    def frames(self) -> set[str]:
        moving = {parent for links in self.links.values() for parent, _ in links}
        return moving.union(self.links, self.fixed, *self.fixed.values())


def check_senders(heard: Heard, moving: str, fixed: str) -> Iterator[Finding]:
    """Find frames that are sent by two, or below two parents.

    :param moving: who publishes /tf.
    :param fixed: who publishes /tf_static.
    """
    for child, links in sorted(heard.links.items()):
        parents = [parent for parent, _ in links]
        if why := _why_it_jumps(heard, child, parents):
            yield Finding(
                f'frame {child}',
                why,
                f'let one node alone publish it, below one parent; on {TRANSFORMS} publish '
                f'{moving}',
            )
        if child in heard.fixed:
            yield Finding(
                f'frame {child}',
                f'is on {FIXED}, below {_shown(heard.fixed[child])}, and on {TRANSFORMS}, below '
                f'{_shown(parents)}, so that the one takes the place of the other',
                f'let one node alone publish it; on {FIXED} publish {fixed}; on {TRANSFORMS} '
                f'{moving}',
            )
    for child, above in sorted(heard.fixed.items()):
        if len(above) > 1 and ', ' in fixed:  # one alone has moved it
            yield Finding(
                f'frame {child}',
                f'has several parents on {FIXED}, {_shown(above)}, of which the last that comes '
                'is taken',
                f'let one node alone publish it, below one parent; on {FIXED} publish {fixed}',
            )


def check_refused(heard: Heard, publishing: str) -> Iterator[Finding]:
    """Find transforms that tf2 takes from nobody: only the listeners' terminals tell."""
    for child, why in sorted(heard.refused.items()):
        yield Finding(
            f'frame {child}' if child else TRANSFORMS,
            f'every listener ignores it, because {why}',
            f'mend what its node fills in; publishing are {publishing}',
        )


def _why_refused(child: str, parent: str, transform: Any) -> str:
    """Say why `tf2::BufferCore::setTransform` refuses a transform, '' where it does not."""
    if not child or not parent:
        return f'its {"header.frame_id" if child else "child_frame_id"} is empty'
    if child == parent:
        return 'it is below itself'
    to, turn = transform.translation, transform.rotation
    length = math.hypot(turn.x, turn.y, turn.z, turn.w)
    if math.isnan(to.x + to.y + to.z + length):
        return 'it has a NaN'
    return '' if length else 'its rotation is all 0, and w of no rotation 1'


def check_roots(heard: Heard) -> Iterator[Finding]:
    """Find trees whose root is named nearly as a frame of another tree: it was to hang there."""
    parents = {child: set(above) for child, above in heard.fixed.items()}
    for child, links in heard.links.items():
        parents.setdefault(child, set()).update(parent for parent, _ in links)
    for root in sorted(set().union(*parents.values()) - parents.keys()):
        own = _below(root, parents)
        others = [each for each in parents if each not in own and _is_beside(each, root)]
        if near := difflib.get_close_matches(root, others, n=1, cutoff=_ALIKE):
            children = [child for child, above in parents.items() if root in above]
            yield Finding(
                f'frame {root}',
                f'is a tree of its own, with {_shown(children)} below it, while another tree has '
                f'{near[0]}, so that lookups between the two fail',
                f'name the parent {near[0]}, or publish where {root} is',
                serious=False,
            )


def _below(root: str, parents: dict[str, set[str]]) -> set[str]:
    found = {root}
    while new := {child for child, above in parents.items() if above & found} - found:
        found |= new
    return found


def _is_beside(frame: str, root: str) -> bool:
    """Tell whether two frames have one prefix: robots that differ by it have alike trees."""
    return frame.rpartition('/')[0] == root.rpartition('/')[0]


def _why_it_jumps(heard: Heard, child: str, parents: list[str]) -> str:
    """Say why a frame of /tf jumps, '' where it does not."""
    # One that is handed over, as a cup from the table to the hand, changes once.
    if sum(a != b for a, b in itertools.pairwise(parents)) > 1:
        return f'has several parents, {_shown(parents)}, so that it jumps between them'
    if len(heard.places[child]) > 1 and _are_of_several(heard.numbers[child]):
        return 'is sent by several publishers, so that it jumps between what they say'
    return ''


def _are_of_several(numbers: list[int]) -> bool:
    """Tell whether messages with these numbers, which each publisher counts, came from several.

    One that was started anew begins at 1, and does not go on where it was.
    """
    highest = 0
    goes_back = False
    for number in numbers:
        if goes_back and number > highest:
            return True
        goes_back = goes_back or number <= highest
        highest = max(highest, number)
    return False


def _shown(names: Iterable[str]) -> str:
    return ' and '.join(sorted(set(names)))


def seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec * 1e-9)
