# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Keep the transforms between frames for some seconds, and look them up."""

from __future__ import annotations

import re
import threading
from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.time import Time

from tf2_py.caches import Cache, LATEST, Sample, seconds, StaticCache, TimeCache
from tf2_py.exceptions import InvalidArgumentException, LookupException, TransformException
from tf2_py.faults import faults_of
from tf2_py.motions import as_from_matrix, compose, IDENTITY, Motion
from tf2_py.paths import describe, find_path, latest_common_time, Path

DEFAULT_CACHE_TIME = 10 * 10**9  # ns
_PLAIN = re.compile(r'\w[\w/.:+-]*')  # what needs no quotes as a key in YAML
_UNNAMED = RcutilsLogger()  # tf2 logs without a name


class BufferCore:
    """A tree of frames over time; may be used by several threads.

    Frames are named with or without one leading slash where they are set, without where they are
    looked up.

    :param cache_time: how long transforms are kept, a Duration; None: 10 s.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._cache_time = (
            DEFAULT_CACHE_TIME if cache_time is None else _nanoseconds(cache_time, 'duration')
        )
        self._frames: dict[str, Cache | None] = {}
        self._authorities: dict[str, str] = {}
        self._lock = threading.RLock()

    def set_transform(self, transform: TransformStamped, authority: str) -> None:
        """Add a transform that holds at its time; a wrong one is logged and left out.

        :param authority: who says so, for messages and the list of frames.
        """
        self._set(transform, authority, static=False)

    def set_transform_static(self, transform: TransformStamped, authority: str) -> None:
        """Set a transform that holds at all times."""
        self._set(transform, authority, static=True)

    def _set(self, transform: TransformStamped, authority: str, *, static: bool) -> None:
        parent = transform.header.frame_id.removeprefix('/')
        child = transform.child_frame_id.removeprefix('/')
        translation, rotation = transform.transform.translation, transform.transform.rotation
        motion = Motion(
            as_from_matrix((rotation.x, rotation.y, rotation.z, rotation.w)),
            (translation.x, translation.y, translation.z),
        )
        stamp = _nanoseconds(transform.header.stamp)
        faults = faults_of(parent, child, motion, authority)
        for fault in faults:
            _UNNAMED.error(fault)
        if faults:
            return
        sample = Sample(motion, parent)
        with self._lock:
            kept = self._cache_of(child, sample, static=static).insert(stamp, sample)
            self._frames.setdefault(parent, None)
            if kept:
                self._authorities[child] = authority
        if not kept:
            _UNNAMED.warning(
                f'TF_OLD_DATA ignoring data from the past for frame {child} at time '
                f'{seconds(stamp)} according to authority {authority}\n'
                'Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained'
            )

    def _cache_of(self, child: str, sample: Sample, *, static: bool) -> Cache:
        """Return the cache of a frame; a new one where it becomes static, or is no longer."""
        cache = self._frames.get(child)
        if not isinstance(cache, StaticCache if static else TimeCache):
            cache = StaticCache(sample) if static else TimeCache(self._cache_time)
            self._frames[child] = cache
        return cache

    def clear(self) -> None:
        """Forget all transforms that are not static."""
        with self._lock:
            for cache in self._frames.values():
                if cache is not None:
                    cache.clear()

    def lookup_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Return what takes coordinates in the source frame into the target frame.

        :param time: a Time, or a message of one; 0: the newest that all on the way have.
        :raises TransformException: there is none; which class says why.
        """
        _require_strings(target_frame, source_frame)
        motion, stamp = self._lookup(target_frame, source_frame, _nanoseconds(time))
        return _message(target_frame, source_frame, motion, stamp)

    def lookup_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> TransformStamped:
        """Return what takes the source frame at one time into the target frame at another.

        :param fixed_frame: what has not moved between the two times.
        """
        _require_strings(target_frame, source_frame, fixed_frame)
        with self._lock:
            self._require(target_frame, 'lookupTransform argument target_frame')
            self._require(source_frame, 'lookupTransform argument source_frame')
            self._require(fixed_frame, 'lookupTransform argument fixed_frame')
            before, _ = self._lookup(fixed_frame, source_frame, _nanoseconds(source_time))
            after, stamp = self._lookup(target_frame, fixed_frame, _nanoseconds(target_time))
        return _message(target_frame, source_frame, compose(after, before), stamp)

    def _lookup(self, target: str, source: str, time: int) -> tuple[Motion, int]:
        with self._lock:
            if target == source:
                newest = latest_common_time(self._frames, target, source)
                return IDENTITY, newest if time == LATEST else time
            path = self._path(target, source, time)
            return path.motion(self._frames), path.time

    def _path(self, target: str, source: str, time: int) -> Path:
        self._require(target, 'lookupTransform argument target_frame')
        self._require(source, 'lookupTransform argument source_frame')
        return find_path(self._frames, target, source, time)

    def _require(self, frame: str, argument: str) -> None:
        unfit = _why_unfit(frame)
        if unfit:
            raise InvalidArgumentException(
                f'Invalid argument "{frame}" passed to {argument} - {unfit}'
            )
        if frame not in self._frames:
            raise LookupException(f'"{frame}" passed to {argument} does not exist. ')

    def can_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> tuple[int, str]:
        """Return 1, or 0 and what a lookup would lack, as the C++ does."""
        _require_strings(target_frame, source_frame)
        nanoseconds = _nanoseconds(time)
        if target_frame == source_frame:
            return 1, ''
        with self._lock:
            problem = self._problem(target=target_frame, source=source_frame)
            return self._can(target_frame, source_frame, nanoseconds, problem)

    def can_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> tuple[int, str]:
        """Return whether lookup_transform_full_core would give a transform."""
        _require_strings(target_frame, source_frame, fixed_frame)
        times = _nanoseconds(target_time), _nanoseconds(source_time)
        with self._lock:
            problem = self._problem(target=target_frame, source=source_frame, fixed=fixed_frame)
            possible = self._can(target_frame, fixed_frame, times[0], problem)
            if not possible[0]:
                return possible
            return self._can(fixed_frame, source_frame, times[1], '')

    def _can(self, target: str, source: str, time: int, problem: str) -> tuple[int, str]:
        if problem:
            return 0, problem
        try:
            find_path(self._frames, target, source, time)
        except TransformException as error:
            return 0, str(error)
        return 1, ''

    def _problem(self, **frames: str) -> str:
        """Say what is wrong with the names of frames; '' where nothing is."""
        for role, frame in frames.items():
            unfit = _why_unfit(frame) or ('' if frame in self._frames else 'frame does not exist')
            if unfit:
                return (
                    f'Invalid frame ID "{frame}" passed to canTransform argument {role}_frame - '
                    f'{unfit}'
                )
        return ''

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the newest time that all transforms between two frames have."""
        _require_strings(target_frame, source_frame)
        with self._lock:
            for frame in (target_frame, source_frame):
                self._require(frame, 'get_latest_common_time')
            try:
                latest = latest_common_time(self._frames, target_frame, source_frame)
            except TransformException as error:
                raise TransformException(str(error)) from None
        return Time(nanoseconds=latest)

    def all_frames_as_string(self) -> str:
        """Return a line for each frame that has a parent."""
        with self._lock:
            return describe(self._frames)

    def all_frames_as_yaml(self) -> str:
        """Return parent, broadcaster, rate and times of each frame that has a parent."""
        with self._lock:
            if not self._frames:
                return '[]'
            return ''.join(
                _yaml(name, cache, self._authorities.get(name, 'no recorded authority'))
                for name, cache in self._frames.items()
                if cache is not None and cache.latest_parent is not None
            )

    def _frameExists(self, frame_id: str) -> bool:  # noqa: N802
        return frame_id in self._frames

    def _getFrameStrings(self) -> list[str]:  # noqa: N802
        return list(self._frames)

    def _chain(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> list[str]:
        """Return the frames from the source to the target, by way of the fixed frame."""
        with self._lock:
            before = self._path(fixed_frame, source_frame, _nanoseconds(source_time)).chain()
            after = self._path(target_frame, fixed_frame, _nanoseconds(target_time)).chain()
        return before + after[1:]


def _why_unfit(frame: str) -> str:
    if not frame:
        return 'in tf2 frame_ids cannot be empty'
    return "in tf2 frame_ids cannot start with a '/'" if frame.startswith('/') else ''


def _require_strings(*frames: str) -> None:
    for number, frame in enumerate(frames, start=1):
        if not isinstance(frame, str):
            raise TypeError(f'argument {number} must be str, not {type(frame).__name__}')


def _nanoseconds(time: Any, kind: str = 'time') -> int:
    """Read a message of a time or a duration, or one of rclpy's."""
    try:
        if hasattr(time, 'sec'):
            return int(time.sec * 10**9 + time.nanosec)
        return int(time.nanoseconds)
    except AttributeError:
        raise TypeError(f'{kind} must have sec and nanosec, or nanoseconds.') from None


def _message(target: str, source: str, motion: Motion, stamp: int) -> TransformStamped:
    message = TransformStamped()
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    message.header.frame_id, message.child_frame_id = target, source
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = motion.translation
    rotation.x, rotation.y, rotation.z, rotation.w = as_from_matrix(motion.rotation)
    return message


def _yaml(name: str, cache: Cache, authority: str) -> str:
    span = cache.latest_stamp - cache.oldest_stamp
    rate = len(cache) * 1e9 / max(span, 100_000)  # of one sample, or all at once: 10 kHz each
    return (
        f'{name if _PLAIN.fullmatch(name) else _quoted(name)}: \n'
        f'  parent: {_quoted(cache.latest_parent or "")}\n  broadcaster: {_quoted(authority)}\n'
        f'  rate: {rate:.3f}\n'
        f'  most_recent_transform: {seconds(cache.latest_stamp)}\n'
        f'  oldest_transform: {seconds(cache.oldest_stamp)}\n'
        f'  buffer_length: {span * 1e-9:.3f}\n'
    )


def _quoted(text: str) -> str:
    """Return text as YAML reads it back, whatever is in it: a name may come from anybody."""
    if text.isprintable() and "'" not in text:
        return f"'{text}'"  # as tf2 writes all of them
    escaped = (
        each if each.isprintable() and each not in '"\\' else f'\\U{ord(each):08x}'
        for each in text
    )
    return f'"{"".join(escaped)}"'
