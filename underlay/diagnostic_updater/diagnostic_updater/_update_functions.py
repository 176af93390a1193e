# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks that many nodes have: how often something happens, how old stamps are, a sign of life."""

from __future__ import annotations

from collections.abc import Mapping
import threading

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.time import Time

from diagnostic_updater._diagnostic_status_wrapper import DiagnosticStatusWrapper
from diagnostic_updater._tasks import DiagnosticTask

_NS_IN_S = 1e-9


def _now() -> Time:
    """Return the time of the wall: as upstream's, the clock follows no /clock."""
    return Clock(clock_type=ClockType.ROS_TIME).now()


class FrequencyStatusParam:
    """
    How often something has to happen.

    :param freq_bound: 'min' and, where there is one, 'max', in Hz; may be changed later.
    :param tolerance: the share of them by which they may be missed.
    :param window_size: over how many runs of the task events are counted.
    """

    def __init__(
        self, freq_bound: Mapping[str, float], tolerance: float = 0.1, window_size: int = 5
    ) -> None:
        self.freq_bound = freq_bound
        self.tolerance = tolerance
        self.window_size = window_size


class FrequencyStatus(DiagnosticTask):
    """Counts calls of `tick`; bad where none came, or too few or too many for their time."""

    def __init__(self, params: FrequencyStatusParam, name: str = 'FrequencyStatus') -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget all events."""
        with self.lock:
            self.count = 0
            self.times = [_now()] * self.params.window_size
            self.seq_nums = [0] * self.params.window_size
            self.hist_indx = 0

    def tick(self) -> None:
        """Count an event."""
        with self.lock:
            self.count += 1

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            now, count, oldest = _now(), self.count, self.hist_indx
            events = count - self.seq_nums[oldest]
            window_sec = (now - self.times[oldest]).nanoseconds * _NS_IN_S
            self.seq_nums[oldest] = count
            self.times[oldest] = now
            self.hist_indx = (oldest + 1) % self.params.window_size
        frequency_hz = events / window_sec if window_sec else 0.0
        bound, tolerance = self.params.freq_bound, self.params.tolerance
        least_hz = bound['min'] * (1 - tolerance)
        most_hz = bound['max'] * (1 + tolerance) if 'max' in bound else None
        if events == 0:
            stat.summary(DiagnosticStatus.ERROR, 'No events recorded.')
        elif frequency_hz < least_hz:
            stat.summary(DiagnosticStatus.WARN, 'Frequency too low.')
        elif most_hz is not None and frequency_hz > most_hz:
            stat.summary(DiagnosticStatus.WARN, 'Frequency too high.')
        else:
            stat.summary(DiagnosticStatus.OK, 'Desired frequency met')
        stat.add('Events in window', f'{events}')
        stat.add('Events since startup', f'{count}')
        stat.add('Duration of window (s)', f'{window_sec:f}')
        stat.add('Actual frequency (Hz)', f'{frequency_hz:f}')
        if bound.get('max') == bound['min']:
            stat.add('Target frequency (Hz)', f'{bound["min"]:f}')
        if bound['min'] > 0:
            stat.add('Minimum acceptable frequency (Hz)', f'{least_hz:f}')
        if most_hz is not None:
            stat.add('Maximum acceptable frequency (Hz)', f'{most_hz:f}')
        return stat


class TimeStampStatusParam:
    """How many s a stamp may be before the time at which it comes; below 0, after it."""

    def __init__(self, min_acceptable: float = -1, max_acceptable: float = 5) -> None:
        self.max_acceptable = max_acceptable
        self.min_acceptable = min_acceptable


class TimeStampStatus(DiagnosticTask):
    """Looks at how old stamps are when they come; bad until the next run where one is not."""

    def __init__(
        self, params: TimeStampStatusParam | None = None, name: str = 'Timestamp Status'
    ) -> None:
        super().__init__(name)
        self.params = params or TimeStampStatusParam()
        self.lock = threading.Lock()
        self.early_count = 0
        self.late_count = 0
        self.zero_count = 0
        self._forget()

    def _forget(self) -> None:
        self.zero_seen = False
        self.max_delta = 0.0
        self.min_delta = 0.0
        self.deltas_valid = False

    def tick(self, stamp: float | Time) -> None:
        """
        Take a stamp in.

        :param stamp: in s, or a time of rclpy.
        :raises TypeError: it is something else.
        """
        if isinstance(stamp, Time):
            stamp = stamp.nanoseconds * _NS_IN_S
        elif not isinstance(stamp, float):
            raise TypeError(
                f'{stamp!r} is no stamp: a float of s is one, or rclpy.time.Time, which '
                'Time.from_msg makes of header.stamp'
            )
        with self.lock:
            if stamp == 0:
                self.zero_seen = True
                return
            delta = _now().nanoseconds * _NS_IN_S - stamp
            self.max_delta = max(self.max_delta, delta) if self.deltas_valid else delta
            self.min_delta = min(self.min_delta, delta) if self.deltas_valid else delta
            self.deltas_valid = True

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            self._summarize(stat)
            for key, value in {
                'Earliest timestamp delay:': f'{self.min_delta:f}',
                'Latest timestamp delay:': f'{self.max_delta:f}',
                'Earliest acceptable timestamp delay:': f'{self.params.min_acceptable:f}',
                'Latest acceptable timestamp delay:': f'{self.params.max_acceptable:f}',
                'Late diagnostic update count:': f'{self.late_count}',
                'Early diagnostic update count:': f'{self.early_count}',
                'Zero seen diagnostic update count:': f'{self.zero_count}',
            }.items():
                stat.add(key, value)
            self._forget()
        return stat

    def _summarize(self, stat: DiagnosticStatusWrapper) -> None:
        stat.summary(DiagnosticStatus.OK, 'Timestamps are reasonable.')
        if not self.deltas_valid:
            stat.summary(DiagnosticStatus.WARN, 'No data since last update.')
            return
        if self.min_delta < self.params.min_acceptable:
            stat.summary(DiagnosticStatus.ERROR, 'Timestamps too far in future seen.')
            self.early_count += 1
        if self.max_delta > self.params.max_acceptable:
            stat.summary(DiagnosticStatus.ERROR, 'Timestamps too far in past seen.')
            self.late_count += 1
        if self.zero_seen:
            stat.summary(DiagnosticStatus.ERROR, 'Zero timestamp seen.')
            self.zero_count += 1


class Heartbeat(DiagnosticTask):
    """Says that the node is alive, whenever it is asked."""

    def __init__(self) -> None:
        super().__init__('Heartbeat')

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.summary(DiagnosticStatus.OK, 'Alive')
        return stat
