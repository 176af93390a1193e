# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The executor that the nodes of the driver spin in."""

from __future__ import annotations

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor


def make_executor(context: rclpy.Context | None = None) -> Executor:
    """Return the executor with the least overhead that this rclpy has."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:  # the first Jazzy releases
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)
