# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How time passes for controllers of every kind, tick by tick, without DDS."""

from __future__ import annotations

from collections.abc import Callable
import time

from husky_grader.run.answering import (
    Answering,
    MEET_TICKS,
    Mode,
    OVERDUE_TICKS,
    QUIET_TICKS,
    Rhythm,
    START_TICKS,
)
import pytest

PERIOD_SEC = 0.02


class Robot:
    """Stands for the simulator: counts its periods, and lets a controller answer each."""

    def __init__(self, answer: Callable[[Robot], object] = lambda _: None) -> None:
        self.has_followers = self.has_commanders = self.has_drivers = self.commanded = True
        self.periods = self.published = 0
        self.pace = Answering(self, 100.0)
        self._answer = answer

    @property
    def time_sec(self) -> float:
        return self.periods * PERIOD_SEC

    def advance(self) -> None:
        self.periods += 1
        self.publish()

    def publish(self) -> None:
        self.published += 1
        self._answer(self)

    def end(self, why: str) -> None:
        raise AssertionError(why)

    def tick(self, ticks: int) -> None:
        for _ in range(ticks):
            self.pace.tick()


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
    for answered in range(2, 100):
        robot.tick(3)
        robot.pace.on_command()
        assert robot.periods == answered
    assert str(robot.pace).startswith('in lockstep')


def test_a_slow_answer_changes_nothing() -> None:
    quick, slow = Robot(), Robot()
    for robot, ticks in ((quick, 0), (slow, 400)):
        robot.tick(1)
        robot.pace.on_command()
        robot.tick(QUIET_TICKS)
        for _ in range(20):
            robot.tick(ticks)
            robot.pace.on_command()
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
    robot.tick(300)
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
    robot.tick(QUIET_TICKS + 1000)
    assert robot.pace.mode is Mode.CLOCKED
    assert str(robot.pace) == 'by its own clock, at 100 x real time at most'


def test_one_that_fell_silent_is_waited_for_again_when_it_speaks() -> None:
    robot = Robot()
    robot.tick(1)
    robot.pace.on_command()
    robot.tick(QUIET_TICKS)
    robot.pace.on_command()
    robot.tick(1000)
    assert robot.pace.mode is Mode.SILENT
    robot.pace.on_command()
    periods = robot.periods
    robot.tick(100)
    assert (robot.pace.mode, robot.periods) == (Mode.ANSWERS, periods)


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


def test_time_waits_for_a_command_that_is_due_but_not_for_ever() -> None:
    robot = Robot()
    robot.has_followers = False
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
    robot = Robot()
    robot.pace.on_command()  # before any odometry: it has a clock of its own
    for _ in range(200):
        robot.pace.on_command()
        robot.pace.on_command()
        time.sleep(0.0005)  # its pace is that of the clock
        robot.tick(1)
    assert robot.periods > 20
