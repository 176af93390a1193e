# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes spin with whatever executors this Jazzy has."""

import sys

from husky_runtime.executor import make_executor, spin
import pytest
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future


def test_a_node_spins_without_the_executor_of_later_releases(
    domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # rclpy.experimental came with rclpy 7.1.4.
    monkeypatch.setitem(sys.modules, 'rclpy.experimental', None)
    rclpy.init(domain_id=domain)
    try:
        assert isinstance(make_executor(), SingleThreadedExecutor)
        node = rclpy.create_node('spun')
        called: Future[None] = Future()
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        node.create_timer(0.01, lambda: called.set_result(None), clock=steady)
        spin(node, until=called)
        node.destroy_node()
    finally:
        rclpy.shutdown()
