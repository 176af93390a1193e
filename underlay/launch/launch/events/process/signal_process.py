# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Please send a signal to a process."""

from __future__ import annotations

from collections.abc import Callable
import signal as signals
from typing import Any

from .process_targeted_event import ProcessTargetedEvent


class SignalProcess(ProcessTargetedEvent):
    """Asks to send a signal to processes.

    :param signal_number: a number, ``signal.SIGINT`` or the name as text.
    """

    name = 'launch.events.process.SignalProcess'

    def __init__(
        self, *, signal_number: str | int | signals.Signals, process_matcher: Callable[[Any], bool]
    ) -> None:
        super().__init__(process_matcher=process_matcher)
        if isinstance(signal_number, str):
            self.signal = signals.Signals[signal_number]
        else:
            self.signal = signals.Signals(signal_number)
        self.signal_name = self.signal.name
