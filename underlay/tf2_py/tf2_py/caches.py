# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The transforms of one frame to its parent: by time, or one for all times."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import NamedTuple

from tf2_py.exceptions import ExtrapolationException
from tf2_py.motions import interpolate, Motion

LATEST = 0  # a time of zero asks for the newest


class Sample(NamedTuple):
    """Where a frame is in its parent."""

    motion: Motion
    parent: str


class TimeCache:
    """The samples of some seconds, ordered by time; in nanoseconds, as all times here."""

    def __init__(self, duration: int) -> None:
        self._duration = duration
        self._stamps: list[int] = []
        self._samples: list[Sample] = []

    def __len__(self) -> int:
        return len(self._stamps)

    @property
    def latest_stamp(self) -> int:
        return self._stamps[-1] if self._stamps else 0

    @property
    def oldest_stamp(self) -> int:
        return self._stamps[0] if self._stamps else 0

    @property
    def latest_parent(self) -> str | None:
        return self._samples[-1].parent if self._samples else None

    def insert(self, stamp: int, sample: Sample) -> bool:
        """Keep a sample; say whether it was young enough."""
        earliest = self.latest_stamp - self._duration
        outdated = bisect_left(self._stamps, earliest)
        del self._stamps[:outdated], self._samples[:outdated]
        if self._stamps and stamp < earliest:
            return False
        end = bisect_right(self._stamps, stamp)
        same_time = self._samples[bisect_left(self._stamps, stamp, hi=end) : end]
        if sample not in same_time:
            self._stamps.insert(end, stamp)
            self._samples.insert(end, sample)
        return True

    def clear(self) -> None:
        self._stamps.clear()
        self._samples.clear()

    def parent(self, time: int) -> str:
        """Return the parent at this time.

        :raises ExtrapolationException: there are no samples on both sides of it.
        """
        return self._samples[self._index(time)].parent

    def sample(self, time: int) -> Sample:
        """Return the sample of this time, between two where there is none.

        :raises ExtrapolationException: there are no samples on both sides of it.
        """
        index = self._index(time)
        before, stamp = self._samples[index], self._stamps[index]
        if time in (LATEST, stamp):
            return before
        after = self._samples[index + 1]
        if before.parent != after.parent:
            return before
        ratio = (time - stamp) / (self._stamps[index + 1] - stamp)
        return Sample(interpolate(before.motion, after.motion, ratio), before.parent)

    def _index(self, time: int) -> int:
        """Return the index of the newest sample that is not after this time."""
        if not self._stamps:
            raise ExtrapolationException('')
        oldest, latest = self._stamps[0], self._stamps[-1]
        if time in (LATEST, latest):
            return len(self._stamps) - 1
        if time == oldest:
            return 0
        if len(self._stamps) == 1:
            raise ExtrapolationException(
                f'Lookup would require extrapolation at time {seconds(time)}, but only time '
                f'{seconds(latest)} is in the buffer'
            )
        if time > latest:
            raise ExtrapolationException(
                'Lookup would require extrapolation into the future.  Requested time '
                f'{seconds(time)} but the latest data is at time {seconds(latest)}'
            )
        if time < oldest:
            raise ExtrapolationException(
                'Lookup would require extrapolation into the past.  Requested time '
                f'{seconds(time)} but the earliest data is at time {seconds(oldest)}'
            )
        return bisect_right(self._stamps, time) - 1


class StaticCache:
    """One sample, which holds at all times."""

    latest_stamp = 0
    oldest_stamp = 0

    def __init__(self, sample: Sample) -> None:
        self._sample = sample

    def __len__(self) -> int:
        return 1

    @property
    def latest_parent(self) -> str:
        return self._sample.parent

    def insert(self, stamp: int, sample: Sample) -> bool:
        """Replace the sample; it is never too old."""
        self._sample = sample
        return True

    def clear(self) -> None:
        """Keep the sample: it is still true after a jump in time."""

    def parent(self, time: int) -> str:
        return self._sample.parent

    def sample(self, time: int) -> Sample:
        return self._sample


Cache = TimeCache | StaticCache


def seconds(nanoseconds: int) -> str:
    """Write a time as tf2 does, which adds the two parts: the last digit depends on that."""
    whole, rest = divmod(nanoseconds, 10**9)
    return f'{whole + 1e-9 * rest:.6f}'
