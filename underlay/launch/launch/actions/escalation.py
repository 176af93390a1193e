# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From a gentle signal to one that cannot be refused."""

from __future__ import annotations

import os
import signal

from ..action import Action
from ..events import matches_action
from ..events.process import SignalProcess
from ..launch_context import LaunchContext
from ..logging import get_logger
from .emit_event import EmitEvent
from .opaque_function import OpaqueFunction
from .timer_action import TimerAction

# Whoever interrupted the launch without a terminal may have interrupted its children as well, and
# a node that is just shutting down does not like a second interrupt.
_LATE_SIGINT_SEC = 0.3


def terminal_reaches_children() -> bool:
    """Return whether Ctrl-C at a terminal goes to the process group of this launch."""
    try:
        terminal = os.open('/dev/tty', os.O_RDONLY | os.O_NOCTTY)
    except OSError:
        return False
    try:
        return os.tcgetpgrp(terminal) == os.getpgrp()
    except OSError:
        return False
    finally:
        os.close(terminal)


def late_sigint(action: Action) -> TimerAction:
    """Return a timer that interrupts a process that has not ended meanwhile."""
    return TimerAction(
        period=_LATE_SIGINT_SEC,
        actions=[emit_signal(action, signal.SIGINT)],
        cancel_on_shutdown=False,
    )


def emit_signal(action: Action, number: signal.Signals) -> EmitEvent:
    """Return an action that has a signal sent to the process of another one."""
    return EmitEvent(
        event=SignalProcess(signal_number=number, process_matcher=matches_action(action))
    )


def _complain(context: LaunchContext, name: str, text: str) -> None:
    del context
    get_logger(name).error(text)


def escalation_timers(
    action: Action, name: str, *, sigterm_sec: float, sigkill_sec: float
) -> list[TimerAction]:
    """Return timers for SIGTERM, and for SIGKILL after it, to be cancelled when it has ended.

    The first is to be executed, and starts the second: also where the launch stood still until
    both would have been due, a process has its time after SIGTERM.

    :param name: of the process, for the messages.
    """

    def escalate(
        period_sec: float,
        waited_sec: float,
        sent: signal.Signals,
        number: signal.Signals,
        *after_it: TimerAction,
    ) -> TimerAction:
        text = (
            f"process[{name}] failed to terminate '{waited_sec:g}' seconds after receiving "
            f"'{sent.name}', escalating to '{number.name}'"
        )
        complain = OpaqueFunction(function=_complain, args=(name, text))
        actions = [complain, emit_signal(action, number), *after_it]
        return TimerAction(period=period_sec, actions=actions, cancel_on_shutdown=False)

    total_sec = sigterm_sec + sigkill_sec
    kill = escalate(sigkill_sec, total_sec, signal.SIGTERM, signal.SIGKILL)
    return [escalate(sigterm_sec, sigterm_sec, signal.SIGINT, signal.SIGTERM, kill), kill]
