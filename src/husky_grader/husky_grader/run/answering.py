# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Pass time as somebody's controller manages it.

One that answers each odometry message with a command is waited for, and its run is as fast as it
can be. One that does anything else is told the time on /clock, at most at the pace that was asked
for, and a control period ends only when the controller is at rest: what it does because of the
simulation, it has done by then. So both drive the same on every machine; one that goes by another
clock, the wall's above all, or is never at rest, does not, and is told so.

What is waited for is counted in ticks of the simulator's timer, not in seconds: on a busy machine
they come later, as the answers do.
"""

from collections import deque
from collections.abc import Callable
from enum import Enum
import time

from husky_sim.simulator_node import Pace, Periods

from husky_sim.config import CONTROL_PERIOD_SEC

TICK_SEC = 0.002
"""Of wall time."""

START_TICKS = round(10.0 / TICK_SEC)
"""For a node that listens to odometry or publishes commands; after that time passes without."""

MEET_TICKS = round(1.0 / TICK_SEC)
"""From a node's subscription to its publisher, or the other way round."""

REPEAT_TICKS = round(2.0 / TICK_SEC)
"""A subscription that is not reliable may have missed the first message."""

QUIET_TICKS = round(0.5 / TICK_SEC)
"""So long time stands after the first command: who sends another does not only answer."""

PROVE_PERIODS = round(1.0 / CONTROL_PERIOD_SEC)
"""In the first ones each answer is looked at twice: a timer may send besides, from 1 Hz on."""

ANSWER_TICKS = round(5.0 / TICK_SEC)
REST_TICKS = round(5.0 / TICK_SEC)
"""For a controller to come to rest; after that time passes without."""

TAKEN_TICKS = 2
"""When it has come to rest in the first, the commands that had come are taken by this one."""

STAND_TICKS = 4
"""
So long time stands at rest: a command that comes after TAKEN_TICKS is by another clock.

So a control period takes five ticks at least, and real time can be had twice as fast.
"""

OVERDUE_TICKS = round(0.5 / TICK_SEC)
"""For a command that is due from a controller that is never at rest."""

_BRIEF, _BRIEF_SPELLS = 10, 3
"""
Who has answered fewer times in a row, and that so often, hears only some messages.

So one does that subscribes anew for each, as `rclpy.wait_for_message`: each that it misses would
be waited for in vain.
"""

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
    CLOCKED = 'at {factor:g} x real time at most: each period waited until all was handled'
    OTHER_CLOCK = (
        'at {factor:g} x real time at most; the controller goes by another clock: runs may differ'
    )
    MISSES = (
        'at {factor:g} x real time at most; the controller misses messages, as one does that '
        'subscribes anew for each (wait_for_message): runs may differ'
    )
    RESTLESS = (
        'at {factor:g} x real time at most; the controller is never at rest: runs may differ'
    )


class Answering(Pace):
    """
    The pace of a graded run.

    :param factor: simulated seconds a second for a controller that is not in lockstep.
    :param at_rest: tells whether the controller has nothing to do now.
    """

    def __init__(self, periods: Periods, factor: float, at_rest: Callable[[], bool]) -> None:
        super().__init__(periods, factor)
        self.mode = Mode.STARTING
        self.alone = False
        self.has_heard = False  # a command
        self._at_rest = at_rest
        self._ticks = 0  # since the last step, or since the start
        self._rest_ticks = 0  # since it came to rest in this control period
        self._met_ticks = 0  # since there is a subscription or a publisher
        self._unanswered = 0  # first odometry messages that may be answered yet
        self._answers = self._answers_in_a_row = self._brief_spells = 0
        self._is_answered = False  # in this control period
        self._to_prove = PROVE_PERIODS
        self._is_timed = True  # whether /clock has told this control period
        self._rhythm = Rhythm()

    @property
    def tick_sec(self) -> float:
        return TICK_SEC

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
                self._advance()
        elif self.mode is Mode.ANSWERS:
            if self._is_answered:
                self._prove()
            elif self._ticks >= ANSWER_TICKS:
                self._fall_silent()
        elif self.mode is Mode.RESTLESS:
            if self._is_awaited():
                self.pacer.restart()  # what it is waited for is not made up for
            else:
                self._keep_pace()
        elif self._rest_ticks or self._at_rest():
            self._end_period()
        elif self._ticks >= REST_TICKS:
            self._change(Mode.RESTLESS)

    def on_command(self) -> None:
        self.has_heard = True
        if self.alone:
            return
        if self.mode in (Mode.STARTING, Mode.FIRST):
            self._unanswered -= 1
            self._change(Mode.FIRST if self._unanswered >= 0 else Mode.CLOCKED)
        elif self.mode in (Mode.ANSWERS, Mode.SILENT):
            self._answers += 1
            self._answers_in_a_row += 1
            self._change(Mode.CLOCKED if self._is_answered else Mode.ANSWERS)
            self._is_answered = True
            if not self._to_prove:
                self._advance()
        elif self.mode is Mode.RESTLESS:
            self._ticks = 0
            self._rhythm.hear(self._periods.time_sec)
        elif self.mode is Mode.CLOCKED and self._rest_ticks >= TAKEN_TICKS:
            self.mode = Mode.OTHER_CLOCK  # nothing that it was told has moved it

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
        self.mode, self._ticks, self._rest_ticks = mode, 0, 0

    def _fall_silent(self) -> None:
        self._brief_spells += self._answers_in_a_row < _BRIEF
        self._answers_in_a_row = 0
        if self._brief_spells == _BRIEF_SPELLS:
            self._change(Mode.MISSES)
        else:
            self._change(Mode.SILENT if self._answers else Mode.CLOCKED)

    def _prove(self) -> None:
        """Advance when the controller is at rest, and an answer was all that it has sent."""
        if self._rest_ticks or self._at_rest():
            self._rest_ticks += 1
        if self._rest_ticks >= TAKEN_TICKS:
            self._to_prove -= 1
            self._advance()
        elif self._ticks >= QUIET_TICKS:  # it is never at rest
            self._to_prove = 0
            self._advance()

    def _advance(self, *, tells_time: bool = True) -> None:
        self._ticks = self._rest_ticks = 0
        self._is_answered, self._is_timed = False, tells_time
        self._periods.advance(tells_time=tells_time)

    def _end_period(self) -> None:
        """Tell the time when the rest of the period is handled, then wait for the next one's."""
        if not self._is_timed:
            self._is_timed = True
            self._periods.publish_clock()
            return
        self._rest_ticks += 1
        if self._rest_ticks >= STAND_TICKS and self.pacer.due(time.monotonic(), most=1):
            self._advance(tells_time=False)

    def _is_awaited(self) -> bool:
        return self._ticks < OVERDUE_TICKS and self._rhythm.is_due(self._periods.time_sec)

    def _keep_pace(self) -> None:
        for _ in range(self.pacer.due(time.monotonic())):
            self._periods.advance()
            if self._is_awaited():
                break


class Rhythm:
    """When the next command of a controller that is never at rest is due, in simulated time."""

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
