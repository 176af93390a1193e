# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How time passes for controllers of every kind, tick by tick, without DDS."""

from __future__ import annotations

import time

from husky_grader.run.answering import (
    _BRIEF,
    _BRIEF_SPELLS,
    ANSWER_TICKS,
    Answering,
    MEET_TICKS,
    Mode,
    OVERDUE_TICKS,
    PROVE_PERIODS,
    QUIET_TICKS,
    REPEAT_TICKS,
    REST_TICKS,
    Rhythm,
    START_TICKS,
    TAKEN_TICKS,
)
import pytest

PERIOD_SEC = 0.02


class Robot:
    """Stands for the simulator: counts its periods and what it publishes."""

    def __init__(self) -> None:
        self.has_followers = self.has_commanders = self.has_drivers = self.commanded = True
        self.periods = self.published = self.timed = 0
        self.rests = True  # its controller
        self.pace = Answering(self, 1000.0, lambda: self.rests)

    @property
    def time_sec(self) -> float:
        return self.periods * PERIOD_SEC

    def advance(self, *, tells_time: bool = True) -> None:
        self.periods += 1
        self.published += 1
        self.timed += tells_time

    def publish(self) -> None:
        self.published += 1
        self.timed += 1

    def publish_to_newcomers(self) -> None:
        pass

    def publish_clock(self) -> None:
        self.timed += 1

    def end(self, why: str) -> None:
        raise AssertionError(why)

    def tick(self, ticks: int) -> None:
        for _ in range(ticks):
            self.pace.tick()

    def tick_to(self, period: int) -> None:
        """Tick until a control period, at the pace of the clock."""
        deadline_sec = time.monotonic() + 10.0
        while self.periods < period:
            self.pace.tick()
            assert time.monotonic() < deadline_sec, f'time stands in period {self.periods}'


def test_time_stands_until_somebody_is_there() -> None:
    robot = Robot()
    robot.has_followers = robot.has_commanders = False
    robot.tick(START_TICKS - 1)
    assert (robot.periods, robot.published) == (0, 0)


def test_without_anybody_time_passes_in_the_end() -> None:
    robot = Robot()
    robot.has_followers = robot.has_commanders = False
    robot.tick(START_TICKS)
    assert robot.pace.mode is Mode.CLOCKED


def test_one_that_answers_is_in_lockstep_and_never_ahead() -> None:
    robot = Robot()
    robot.tick(1)
    assert robot.published == 1
    robot.pace.on_command()
    robot.tick(QUIET_TICKS - 1)
    assert robot.periods == 0, 'time should stand while it is looked whether it sends more'
    robot.tick(1)
    assert (robot.pace.mode, robot.periods) == (Mode.ANSWERS, 1)
    for answered in range(2, PROVE_PERIODS + 2):
        robot.tick(3)
        robot.pace.on_command()
        assert robot.periods == answered - 1, 'it should be looked whether it sends more'
        robot.tick(TAKEN_TICKS)
        assert robot.periods == answered
    for answered in range(PROVE_PERIODS + 2, PROVE_PERIODS + 20):
        robot.pace.on_command()
        assert robot.periods == answered
    assert str(robot.pace).startswith('in lockstep')


def test_one_that_answers_and_sends_more_is_not_in_lockstep() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    robot.pace.on_command()
    robot.pace.on_command()
    assert (robot.pace.mode, robot.periods) == (Mode.CLOCKED, 1)


def test_one_that_answers_and_is_never_at_rest_is_in_lockstep() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    robot.rests = False
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    assert robot.periods == 2
    robot.pace.on_command()
    assert (robot.pace.mode, robot.periods) == (Mode.ANSWERS, 3)


def test_a_slow_answer_changes_nothing() -> None:
    quick, slow = Robot(), Robot()
    for robot, ticks in ((quick, 0), (slow, ANSWER_TICKS - 1)):
        robot.tick(1)
        robot.pace.on_command()
        robot.tick(QUIET_TICKS)
        for _ in range(20):
            robot.tick(ticks)
            robot.pace.on_command()
            robot.tick(TAKEN_TICKS)
    assert quick.periods == slow.periods == 21
    assert quick.pace.mode is slow.pace.mode is Mode.ANSWERS


def test_who_sends_while_time_stands_has_a_clock_of_its_own() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(20)
    robot.pace.on_command()
    assert robot.pace.mode is Mode.CLOCKED


def test_who_sends_before_any_odometry_has_a_clock_of_its_own() -> None:
    robot = Robot()
    robot.has_followers = False
    robot.pace.on_command()
    assert robot.pace.mode is Mode.CLOCKED


def test_a_repeated_first_message_may_be_answered_twice() -> None:
    robot = Robot()
    robot.tick(REPEAT_TICKS + 1)
    assert robot.published == 2
    robot.pace.on_command()
    robot.pace.on_command()
    assert str(robot.pace) == Mode.FIRST.value
    robot.pace.on_command()
    assert robot.pace.mode is Mode.CLOCKED


def test_one_that_publishes_but_does_not_listen_gets_time() -> None:
    robot = Robot()
    robot.has_followers = False
    robot.tick(MEET_TICKS)
    assert robot.pace.mode is Mode.CLOCKED


def test_one_that_does_not_answer_the_second_message_gets_time() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS + ANSWER_TICKS)
    assert robot.pace.mode is Mode.CLOCKED
    assert str(robot.pace).startswith('at 1000 x real time at most')


def test_one_that_fell_silent_is_waited_for_again_when_it_speaks() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    robot.pace.on_command()
    robot.tick(TAKEN_TICKS + ANSWER_TICKS)
    assert robot.pace.mode is Mode.SILENT
    robot.pace.on_command()
    robot.tick(TAKEN_TICKS)
    periods = robot.periods
    robot.tick(100)
    assert (robot.pace.mode, robot.periods) == (Mode.ANSWERS, periods)


def test_one_that_hears_only_some_messages_gets_time() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    for _ in range(_BRIEF_SPELLS):
        assert robot.pace.mode is Mode.ANSWERS
        robot.tick(2)
        robot.pace.on_command()
        robot.tick(TAKEN_TICKS + ANSWER_TICKS)
        robot.pace.on_command()
    assert str(robot.pace) == Mode.MISSES.value.format(factor=1000)
    robot.tick_to(robot.periods + 5)


def test_one_that_falls_silent_now_and_then_answers_still() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    for _ in range(3 * _BRIEF_SPELLS):
        for _ in range(_BRIEF):
            robot.tick(2)
            robot.pace.on_command()
            robot.tick(TAKEN_TICKS)
        robot.tick(ANSWER_TICKS)
        assert str(robot.pace) == Mode.SILENT.value
        robot.pace.on_command()
        assert str(robot.pace) == Mode.ANSWERS.value


def test_a_controller_that_has_ended_is_not_waited_for() -> None:
    robot = Robot()
    robot.pace.leave_alone()
    robot.tick(5)
    assert robot.periods > 5


@pytest.mark.parametrize('gap_sec', [0.02, 0.1, 0.5])
def test_a_command_is_due_one_gap_after_the_last(gap_sec: float) -> None:
    rhythm = Rhythm()
    for number in range(3):
        assert not rhythm.is_due(1000.0), 'no rhythm is known yet'
        rhythm.hear(number * gap_sec)
    last_sec = 2 * gap_sec
    assert not rhythm.is_due(last_sec + gap_sec - PERIOD_SEC / 2)
    assert rhythm.is_due(last_sec + gap_sec)


def test_an_early_command_does_not_make_the_next_one_due() -> None:
    rhythm = Rhythm()
    for time_sec in (0.0, 0.2, 0.4, 0.42):
        rhythm.hear(time_sec)
    assert not rhythm.is_due(0.6)
    assert rhythm.is_due(0.62)


def on_simulated_time() -> Robot:
    """Return a robot whose controller has sent before any odometry, and so does not answer."""
    robot = Robot()
    robot.pace.on_command()
    return robot


def test_a_period_ends_when_the_controller_is_at_rest() -> None:
    robot = on_simulated_time()
    robot.tick_to(5)
    robot.rests = False
    robot.tick(REST_TICKS - 1)
    assert robot.periods == 5
    robot.rests = True
    robot.tick_to(10)
    assert robot.pace.mode is Mode.CLOCKED


def test_time_is_told_when_all_else_is_handled() -> None:
    robot = on_simulated_time()
    robot.tick_to(1)
    robot.rests = False
    robot.tick(10)
    assert (robot.published, robot.timed) == (1, 0)
    robot.rests = True
    robot.tick(1)
    assert (robot.published, robot.timed) == (1, 1)
    robot.tick_to(2)
    assert (robot.published, robot.timed) == (2, 1)


@pytest.mark.parametrize(
    ('ticks', 'mode'), [(TAKEN_TICKS, Mode.CLOCKED), (TAKEN_TICKS + 1, Mode.OTHER_CLOCK)]
)
def test_a_command_from_one_long_at_rest_is_by_another_clock(ticks: int, mode: Mode) -> None:
    robot = on_simulated_time()
    robot.pace.change(1e-3)  # time enough at rest
    robot.tick_to(1)
    robot.tick(ticks)  # the first tells the time
    robot.pace.on_command()
    assert robot.pace.mode is mode


def restless() -> Robot:
    robot = on_simulated_time()
    robot.rests = False
    robot.tick(REST_TICKS)
    assert robot.pace.mode is Mode.RESTLESS
    return robot


def test_time_waits_for_a_command_that_is_due_but_not_for_ever() -> None:
    robot = restless()
    for _ in range(9):
        robot.pace.on_command()
        robot.advance()
    robot.periods += 10
    before = robot.periods
    robot.tick(OVERDUE_TICKS - 1)
    assert robot.periods == before
    robot.tick(10_000)
    assert robot.periods > before


def test_time_passes_for_one_that_sends_whatever_the_time_is() -> None:
    robot = restless()
    for _ in range(200):
        robot.pace.on_command()
        robot.pace.on_command()
        time.sleep(0.0005)  # its pace is that of the clock
        robot.tick(1)
    assert robot.periods > 20
