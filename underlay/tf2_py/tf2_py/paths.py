# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which frames lie between two: up from the source to the root, and down to the target."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tf2_py.caches import Cache, LATEST
from tf2_py.exceptions import ConnectivityException, ExtrapolationException, LookupException
from tf2_py.motions import compose, IDENTITY, inverse, Motion

Frames = Mapping[str, Cache | None]  # by name, as they came; a root has no cache
_MAX_DEPTH = 1000


class Path(NamedTuple):
    """Frames whose transforms lead from a source to a target, at one time."""

    up: list[str]  # from the source to the root, or to the target where that is on the way
    down: list[str]  # from the target, in the same way
    top: str  # where both end; in neither of them
    time: int

    def chain(self) -> list[str]:
        """Return the frames from the source to the target, by their nearest common parent."""
        up, down, top = [*self.up], [*self.down], self.top
        while up and down and up[-1] == down[-1]:
            top = up.pop()
            down.pop()
        return [*up, top, *reversed(down)]

    def motion(self, frames: Frames) -> Motion:
        """Put the transforms on it together: from the source into the target."""
        up, down = (self._climb(frames, names) for names in (self.up, self.down))
        return compose(inverse(down), up) if self.down else up

    def _climb(self, frames: Frames, names: list[str]) -> Motion:
        motion = IDENTITY
        for name in names:
            cache = frames[name]
            assert cache is not None  # the path was found through it
            motion = compose(cache.sample(self.time).motion, motion)
        return motion


def find_path(frames: Frames, target: str, source: str, time: int) -> Path:
    """Find the path at this time; LATEST: at the newest that all on it have.

    :raises TransformException: there is none; which class says why.
    """
    if source == target:
        return Path([], [], source, time)
    if time == LATEST:
        time = latest_common_time(frames, target, source)
    top, up, failure = _climb_to(target, frames, source, time)
    if top == target:
        return Path(up, [], target, time)
    other_top, down, other_failure = _climb_to(source, frames, target, time, root=top)
    if other_top == source:
        return Path([], down, source, time)
    # Where both lack data upstream tells what the target lacks.
    failure = other_failure or (failure if other_top != top else None)
    if failure is not None:
        raise ExtrapolationException(
            f'{failure}, when looking up transform from frame [{source}] to frame [{target}]'
        )
    if other_top != top:
        raise _no_connection(target, source)
    return Path(up, down, top, time)


def _climb_to(
    end: str, frames: Frames, start: str, time: int, root: str | None = None
) -> tuple[str, list[str], ExtrapolationException | None]:
    """Go up from parent to parent; return the last frame, those before it, what stopped it."""
    names: list[str] = []
    frame = start
    while frame not in (end, root) and (cache := frames.get(frame)) is not None:
        try:
            parent = cache.parent(time)
        except ExtrapolationException as failure:
            return frame, names, failure
        names.append(frame)
        frame = parent
        if len(names) > _MAX_DEPTH:
            raise _loop(frames)
    return frame, names, None


def latest_common_time(frames: Frames, target: str, source: str) -> int:
    """Return the newest time that all transforms between two frames have; 0: all are static.

    :raises TransformException: nothing connects them, or the tree has a loop.
    """
    if source == target:
        cache = frames.get(source)
        return cache.latest_stamp if cache else 0
    up, _ = _climb_latest(frames, source, {target})
    if up and up[-1][1] == target:
        return _earliest(up)
    down, common = _climb_latest(frames, target, {source, *(parent for _, parent in up)})
    if common == source:
        return _earliest(down)
    if common is None:
        raise _no_connection(target, source)
    shared = [parent for _, parent in up].index(common)
    return _earliest(up[: shared + 1] + down)


def _climb_latest(
    frames: Frames, start: str, ends: set[str]
) -> tuple[list[tuple[int, str]], str | None]:
    """Go up by the newest parents to one of the ends; return stamps, parents, and that end."""
    steps: list[tuple[int, str]] = []
    frame = start
    while (cache := frames.get(frame)) is not None:
        parent = cache.latest_parent
        if parent is None:
            break
        steps.append((cache.latest_stamp, parent))
        if parent in ends:
            return steps, parent
        frame = parent
        if len(steps) > _MAX_DEPTH:
            raise _loop(frames)
    return steps, None


def _earliest(steps: list[tuple[int, str]]) -> int:
    return min((stamp for stamp, _ in steps if stamp), default=0)


def describe(frames: Frames) -> str:
    """Return a line for each frame that has a parent."""
    return ''.join(
        f'Frame {name} exists with parent {cache.latest_parent or "NO_PARENT"}.\n'
        for name, cache in frames.items()
        if cache is not None
    )


def _no_connection(target: str, source: str) -> ConnectivityException:
    return ConnectivityException(
        f"Could not find a connection between '{target}' and '{source}' because they are not part "
        'of the same tree.Tf has two or more unconnected trees.'
    )


def _loop(frames: Frames) -> LookupException:
    return LookupException(
        f'The tf tree is invalid because it contains a loop.\n{describe(frames)}\n'
    )
