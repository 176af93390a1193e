# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Measure how late transforms arrive, and how often."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
import sys

from node_program import own_words, run_node
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from tf2_msgs.msg import TFMessage
from tf2_py import TransformException

from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener

_AUTHORITY = '<no authority available>'
_PERIOD_SEC = 0.5
_TICKS_A_REPORT = 21
_LOWPASS = 0.01  # share of the newest net delay in its average


def main() -> int:
    """Report every ten seconds until Ctrl-C; 255: the arguments are wrong, as upstream."""
    frames = own_words(sys.argv)
    if len(frames) not in (0, 2):
        print('TF_Monitor: usage: tf2_monitor framea frameb')
        return 255
    return run_node(lambda _: Monitor(frames), sys.argv)


class Monitor(Node):
    """Keeps the last thousand delays of each frame."""

    def __init__(self, frames: list[str]) -> None:
        super().__init__('tf2_monitor_main')
        self._frames = frames
        self._chain: list[str] = []
        self._delays: dict[str, deque[float]] = {}
        self._all_delays: deque[float] = deque(maxlen=1000)
        self._arrivals: deque[float] = deque(maxlen=1000)
        self._net_average = self._net_max = 0.0
        self._ticks = 0
        self._buffer = Buffer(node=self)
        self._listener = TransformListener(self._buffer, self)
        if not frames:
            self._start('Gathering data on all frames for 10 seconds...')
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(_PERIOD_SEC, self._on_tick, clock=steady)

    def _start(self, said: str) -> None:
        print(said, flush=True)
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, '/tf', self._on_transforms, QoSProfile(depth=100))
        self.create_subscription(TFMessage, '/tf_static', self._on_transforms, latched)

    def _on_transforms(self, message: TFMessage) -> None:
        now = self._now()
        delays = []
        for transform in message.transforms:
            stamp = transform.header.stamp
            delays.append(now - stamp.sec - 1e-9 * stamp.nanosec)
            known = self._delays.setdefault(transform.child_frame_id, deque(maxlen=1000))
            known.append(delays[-1])
        self._all_delays.append(sum(delays) / max(1, len(delays)))
        self._arrivals.append(now)

    def _on_tick(self) -> None:
        if self._frames and not self._chain and not self._find_chain():
            return
        if self._frames:
            self._measure_net_delay()
        self._ticks += 1
        if self._ticks == _TICKS_A_REPORT:
            self._ticks = 0
            print(self._report(), flush=True)

    def _find_chain(self) -> bool:
        first, second = self._frames
        possible, why = self._buffer.can_transform_core(first, second, Time())
        if not possible:
            self.get_logger().info(
                f'Waiting for transform {first} ->  {second}: {why}', throttle_duration_sec=1.0
            )
            return False
        self._chain = self._buffer._chain(second, Time(), first, Time(), second)
        self._start(f'Gathering data on {first} -> {second} for 10 seconds...')
        return True

    def _measure_net_delay(self) -> None:
        first, second = self._frames
        try:
            found = self._buffer.lookup_transform_core(first, second, Time())
        except TransformException as error:
            self.get_logger().warning(f'Transform Exception {error}')
            return
        stamp = found.header.stamp
        delay = self._now() - stamp.sec - 1e-9 * stamp.nanosec
        self._net_average = _LOWPASS * delay + (1.0 - _LOWPASS) * self._net_average
        self._net_max = max(self._net_max, delay)

    def _report(self) -> str:
        lines = ['', '', '']
        if self._frames:
            first, second = self._frames
            lines += [
                f'RESULTS: for {first} to {second}',
                f'Chain is: {" -> ".join(self._chain)}',
                f'Net delay     avg = {self._net_average:g}: max = {self._net_max:g}',
            ]
        else:
            lines.append('RESULTS: for all Frames')
        lines += ['', 'Frames:']
        for frame, delays in sorted(self._delays.items()):
            if not self._chain or frame in self._chain:
                average, longest = _summary(delays)
                lines.append(
                    f'Frame: {frame}, published by {_AUTHORITY}, Average Delay: {average:g}, '
                    f'Max Delay: {longest:g}'
                )
        lines += ['', 'All Broadcasters:']
        if self._arrivals:
            average, longest = _summary(self._all_delays)
            span = max(1e-8, self._arrivals[-1] - self._arrivals[0])
            lines.append(
                f'Node: {_AUTHORITY} {len(self._arrivals) / span:g} Hz, Average Delay: '
                f'{average:g} Max Delay: {longest:g}'
            )
        return '\n'.join(lines)

    def _now(self) -> float:
        return float(self.get_clock().now().nanoseconds * 1e-9)


def _summary(delays: Iterable[float]) -> tuple[float, float]:
    """Return the average and the longest of delays, which is 0 at least."""
    known = list(delays)
    return sum(known) / len(known), max(0.0, *known)


if __name__ == '__main__':
    sys.exit(main())
