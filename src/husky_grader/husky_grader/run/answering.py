# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Pass time as somebody's controller manages it.

One that answers each odometry message with a command is waited for: its run is the same on every
machine, and as fast as it can be. One with a clock of its own is told the time on /clock, at most
at the pace that was asked for, and waited for at the moment when its next command is due, so that
also its run is mostly the same on a busy machine.

What is waited for is counted in ticks of the simulator's timer, not in seconds: on a busy machine
they come later, as the answers do.
"""

from collections import deque
from enum import Enum
import time

from husky_sim.simulator_node import Pace, Periods, POLL_SEC

from husky_sim.config import CONTROL_PERIOD_SEC

START_TICKS = round(10.0 / POLL_SEC)
"""For a node that listens to odometry or publishes commands; after that time passes without."""

MEET_TICKS = round(1.0 / POLL_SEC)
"""From a node's subscription to its publisher, or the other way round."""

REPEAT_TICKS = round(2.0 / POLL_SEC)
"""A subscription that is not reliable may have missed the first message."""

QUIET_TICKS = round(0.5 / POLL_SEC)
"""So long time stands after the first command: who sends another has a clock of its own."""

ANSWER_TICKS = round(5.0 / POLL_SEC)
OVERDUE_TICKS = round(0.5 / POLL_SEC)

_ALONE_TURN = 10
"""Control periods a tick when there is nobody to wait for."""

_GAPS = 8
"""Between commands: so many of the last ones are known."""

_RHYTHM = 2
"""And so many make a rhythm."""


class Mode(Enum):
    """What is known of the controller, and so how time passes; the value tells it."""

    STARTING = 'without a command'
    FIRST = 'after its only command'
    ANSWERS = 'in lockstep: each odometry message waited for its command'
    SILENT = 'in lockstep, until it fell silent'
    CLOCKED = 'by its own clock, at {factor:g} x real time at most'


class Answering(Pace):
    """
    The pace of a graded run.

    :param factor: simulated seconds a second for a controller with a clock of its own.
    """

    def __init__(self, periods: Periods, factor: float) -> None:
        super().__init__(periods, factor)
        self.mode = Mode.STARTING
        self.alone = False
        self._ticks = 0  # since the last step, or since the start
        self._met_ticks = 0  # since there is a subscription or a publisher
        self._unanswered = 0  # first odometry messages that may be answered yet
        self._answers = 0
        self._rhythm = Rhythm()

    @property
    def tick_sec(self) -> float:
        return POLL_SEC

    def __str__(self) -> str:
        return self.mode.value.format(factor=self.factor)

    def tick(self) -> None:
        self._ticks += 1
        if self.alone:
            for _ in range(_ALONE_TURN):
                self._periods.advance()
        elif self.mode is Mode.STARTING:
            self._start()
        elif self.mode is Mode.FIRST:
            if self._ticks >= QUIET_TICKS:
                self._change(Mode.ANSWERS)
                self._periods.advance()
        elif self.mode is Mode.ANSWERS:
            if self._ticks >= ANSWER_TICKS:
                self._change(Mode.SILENT if self._answers else Mode.CLOCKED)
        elif self._is_awaited():
            self.pacer.restart()  # what it is waited for is not made up for
        else:
            self._keep_pace()

    def on_command(self) -> None:
        if self.alone:
            return
        if self.mode in (Mode.STARTING, Mode.FIRST):
            self._unanswered -= 1
            self._change(Mode.FIRST if self._unanswered >= 0 else Mode.CLOCKED)
        elif self.mode is not Mode.CLOCKED:
            self._answers += 1
            self._change(Mode.ANSWERS)
            self._periods.advance()
        if self.mode is Mode.CLOCKED:
            self._ticks = 0
            self._rhythm.hear(self._periods.time_sec)

    def leave_alone(self) -> None:
        """Wait for nobody any more: the controller's process has ended."""
        self.alone = True

    def _start(self) -> None:
        """Publish the first odometry as soon as it can be heard and answered."""
        if self._unanswered:
            if self._ticks >= ANSWER_TICKS:
                self._change(Mode.CLOCKED)
            elif self._ticks % REPEAT_TICKS == 0:
                self._publish_first()
            return
        followed, commanded = self._periods.has_followers, self._periods.has_commanders
        self._met_ticks += followed or commanded
        if followed and (commanded or self._met_ticks >= MEET_TICKS):
            self._ticks = 0
            self._publish_first()
        elif self._met_ticks >= MEET_TICKS or self._ticks >= START_TICKS:
            self._change(Mode.CLOCKED)

    def _publish_first(self) -> None:
        self._unanswered += 1
        self._periods.publish()

    def _change(self, mode: Mode) -> None:
        self.mode, self._ticks = mode, 0

    def _is_awaited(self) -> bool:
        return self._ticks < OVERDUE_TICKS and self._rhythm.is_due(self._periods.time_sec)

    def _keep_pace(self) -> None:
        for _ in range(self.pacer.due(time.monotonic())):
            self._periods.advance()
            if self._is_awaited():
                break


class Rhythm:
    """When the next command of a node with a clock of its own is due, in simulated time."""

    def __init__(self) -> None:
        self._gaps_sec: deque[float] = deque(maxlen=_GAPS)
        self._heard_sec: float | None = None

    def hear(self, time_sec: float) -> None:
        """Take note of a command."""
        if self._heard_sec is not None:
            self._gaps_sec.append(time_sec - self._heard_sec)
        self._heard_sec = time_sec

    def is_due(self, time_sec: float) -> bool:
        """Return whether a command should come by now, after the longest of the last gaps."""
        if self._heard_sec is None or len(self._gaps_sec) < _RHYTHM:
            return False
        # A period at least: for one that sends whatever the time is, time would stand for ever.
        gap_sec = max(CONTROL_PERIOD_SEC, *self._gaps_sec)
        return time_sec > self._heard_sec + gap_sec - 1e-9  # rounding must not decide
