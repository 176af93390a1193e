# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated time against a wall clock that the tests set."""

from husky_sim.ros.pacing import Pacer
import pytest


def test_one_period_is_due_in_every_period() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    assert [pacer.due(10.0 + 0.02 * i + 1e-6) for i in range(100)] == [1] * 100
    assert pacer.overruns == 0


def test_nothing_is_due_too_early() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    assert pacer.due(5.0) == 1
    assert pacer.due(5.01) == 0
    assert pacer.due(5.021) == 1


def test_a_timer_that_jitters_loses_no_period() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    jittered = [0.02 * i + (0.001 if i % 3 else -0.001) for i in range(1, 100)]
    assert [pacer.due(now) for now in jittered] == [1] * 99


@pytest.mark.parametrize('factor', [0.25, 1.0, 3.0, 50.0])
def test_over_a_minute_the_pace_is_the_factor(factor: float) -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=factor)
    periods = sum(pacer.due(i * 0.005) for i in range(12001))
    assert periods * 0.02 / 60.0 == pytest.approx(factor, rel=0.002)


def test_a_short_delay_is_made_up_for() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.due(0.0)
    assert pacer.due(0.085) == 4
    assert pacer.overruns == 0


def test_a_long_stall_is_not_and_is_counted() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.due(0.0)
    assert pacer.due(10.0) == 1
    assert pacer.overruns == 1
    assert pacer.lost_sec == pytest.approx(9.98)
    assert pacer.due(10.021) == 1


def test_another_pace_begins_at_once_and_forgets_no_overrun() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.due(0.0)
    pacer.due(5.0)
    pacer.change(10.0)
    assert [pacer.due(5.01 + 0.002 * i + 1e-6) for i in range(50)] == [1] * 50
    assert pacer.overruns == 1


def test_time_spent_in_a_pause_is_not_made_up_for() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.due(0.0)
    pacer.restart()
    assert pacer.due(0.09) == 1
    assert pacer.overruns == 0


def test_at_most_as_many_as_asked_for() -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.due(0.0)
    assert pacer.due(0.085, most=1) == 1
    assert pacer.due(0.086) == 3


@pytest.mark.parametrize('late_sec', [0.0, 0.003, 0.0055, 0.006, 0.01, 0.015, 0.019])
def test_periods_fall_due_at_ticks_after_a_late_first_one(late_sec: float) -> None:
    pacer = Pacer(period_sec=0.02, real_time_factor=1.0)
    pacer.change(1.0, begin_sec=10.0)
    pacer.due(10.02 + late_sec)
    jittered = [0.0001, 0.0008, 0.016, 0.0015] * 25
    counts = [pacer.due(10.04 + 0.02 * k + late) for k, late in enumerate(jittered)]
    assert set(counts[1:]) == {1}
