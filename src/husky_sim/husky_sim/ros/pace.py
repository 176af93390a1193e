# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
How simulated time passes.

Freely: at real_time_factor times the wall's pace, or as fast as possible (factor 0). In lockstep:
each control period waits for the command that answers the odometry of the one before.
"""

from abc import ABC, abstractmethod
import time
from typing import Protocol

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.ros.pacing import Pacer

REPEAT_SEC = 0.5
"""
How often lockstep repeats its first odometry message, until the first command comes, and the last
one for a driver that has come since: it waits for odometry, while time waits for its command.
"""

HANGING_SEC = 60.0
"""
Without an answer to one message for so long, a run with a limit ends: the driver hangs.

Counted in ticks, which come later on a busy machine, as the answer does.
"""

POLL_SEC = 0.01
"""Between two looks at whether to go on."""

_SHORTEST_TICK_SEC = 0.001

# How long to simulate before the executor handles commands and services. As fast as possible: a
# return to the executor costs as much as half a control period. Behind the wall clock: long enough
# to catch up where a control period takes most of its time.
_TURN_SEC = 0.002
_CATCH_UP_TURN_SEC = 0.02


class Periods(Protocol):
    """The simulation whose time passes, with its topics."""

    @property
    def has_drivers(self) -> bool:
        """Whether every robot's odometry has a subscription, and its commands a publisher."""

    @property
    def has_followers(self) -> bool:
        """Whether any odometry of every robot has a subscription."""

    @property
    def has_commanders(self) -> bool:
        """Whether the commands of every robot have a publisher."""

    @property
    def commanded(self) -> bool:
        """Whether every robot was commanded since the last control period."""

    def advance(self, *, tells_time: bool = True) -> None:
        """
        Advance by one control period and publish it.

        :param tells_time: also on /clock; else call `publish_clock` later.
        """

    def publish(self) -> None:
        """Publish the last control period again."""

    def publish_to_newcomers(self) -> None:
        """Publish it again of the robots whose driver may not have it."""

    def publish_clock(self) -> None:
        """Tell the time on /clock."""

    @property
    def time_sec(self) -> float:
        """Simulated time."""

    def end(self, why: str) -> None:
        """End the run."""


class Pace(ABC):
    """
    One way of passing time; its owner calls `tick` every `tick_sec` of wall time.

    :param factor: simulated seconds a second; 0: as fast as possible.
    """

    waits = True
    """Whether time waits for a driver: that it is late says nothing of the machine."""

    def __init__(self, periods: Periods, factor: float) -> None:
        self._periods = periods
        self.pacer = Pacer(period_sec=CONTROL_PERIOD_SEC, real_time_factor=factor or 1e9)
        self.change(factor)

    def change(self, factor: float) -> None:
        """Continue at another pace; call it when the timer of the ticks begins."""
        self.factor = factor
        self.pacer.change(factor or 1e9, begin_sec=time.monotonic())

    @property
    def tick_sec(self) -> float:
        """Wall time between two ticks; 0: always."""
        if self.factor > 0.0:
            return max(CONTROL_PERIOD_SEC / self.factor, _SHORTEST_TICK_SEC)
        return self._unpaced_tick_sec()

    def _unpaced_tick_sec(self) -> float:
        return POLL_SEC

    @abstractmethod
    def tick(self) -> None:
        """Pass time, if it is time for it."""

    @abstractmethod
    def on_command(self) -> None:
        """Take note of a command."""

    def begin_again(self) -> None:
        """Begin again, after a reset."""
        self.pacer.restart()

    def __str__(self) -> str:
        return f'{self.factor:g} x real time' if self.factor > 0.0 else 'as fast as possible'


class FreePace(Pace):
    """Time passes whatever the drivers do."""

    waits = False

    def _unpaced_tick_sec(self) -> float:
        return 0.0

    def tick(self) -> None:
        free = self.factor == 0.0
        now_sec = time.monotonic()
        end_sec = now_sec + (_TURN_SEC if free else _CATCH_UP_TURN_SEC)
        while now_sec < end_sec and (free or self.pacer.due(now_sec, most=1)):
            self._periods.advance()
            now_sec = time.monotonic()

    def on_command(self) -> None:
        """Nothing waits for it."""


class Lockstep(Pace):
    """
    Each control period waits for the command that answers the odometry of the one before.

    :param limited: whether the run has an end of its own, also where a driver hangs.
    """

    def __init__(self, periods: Periods, factor: float, *, limited: bool) -> None:
        super().__init__(periods, factor)
        self._limited = limited
        self._begun = False  # the first odometry message is out
        self._answered = False  # and was answered
        self._ticks = 0  # since the last control period
        self._repetitions = 1  # of its messages, and the first
        self._sent_at_sec = 0.0

    def tick(self) -> None:
        """Begin, repeat a message that was not heard, or use a command that came too early."""
        if self._answered:
            self._advance_if_answered()
            self._ticks += 1
            if self._ticks * self.tick_sec >= REPEAT_SEC * self._repetitions:
                self._repetitions += 1
                self._periods.publish_to_newcomers()
            if self._limited and self._ticks * self.tick_sec > HANGING_SEC:
                self._periods.end(f'no command for {HANGING_SEC:g} s: the driver hangs')
            return
        now_sec = time.monotonic()
        if self._begun:
            due = now_sec - self._sent_at_sec >= REPEAT_SEC
        else:
            due = self._periods.has_drivers
        if due:
            self._begun, self._sent_at_sec = True, now_sec
            self._periods.publish()

    def on_command(self) -> None:
        self._answered = True
        self._advance_if_answered()

    def _advance_if_answered(self) -> None:
        if not self._periods.commanded:
            return
        if self.factor > 0.0 and not self.pacer.due(time.monotonic(), most=1):
            return
        self._ticks, self._repetitions = 0, 1
        self._periods.advance()

    def begin_again(self) -> None:
        super().begin_again()
        self._begun = self._answered = False

    @property
    def has_begun(self) -> bool:
        """Whether a driver was found for every robot, or somebody has commanded one."""
        return self._begun or self._answered

    def __str__(self) -> str:
        return f'lockstep, {super().__str__()}'
