# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Base of what is asked of processes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...event import Event


class ProcessTargetedEvent(Event):
    """Asks something of the processes that its matcher accepts."""

    name = 'launch.events.process.ProcessTargetedEvent'

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher
