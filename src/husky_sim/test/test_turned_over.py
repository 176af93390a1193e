# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that has turned over: noticed once a run, and recorded."""

import math
from pathlib import Path

from husky_course.record import FILE_NAME, Overturn, read_record, read_run
from husky_course.robot import RobotStart
from husky_sim.recording.recorder import RunRecorder
from husky_sim.robot.husky import RobotState
from husky_sim.simulation import Simulation
from husky_sim.world.world import default_worlds
import pytest

from husky_sim.config import SimulationConfig

# Aslant towards the barrier in the middle of the playpen: with one side of wheels it climbs it.
ASLANT = RobotStart(x=2.22, y=1.7, yaw=math.radians(-70.0))


@pytest.fixture
def simulation() -> Simulation:
    world = str(default_worlds() / 'playpen.xml')
    return Simulation(SimulationConfig(world=world, robots=(ASLANT,)))


def drive(simulation: Simulation, recorder: RunRecorder) -> list[float]:
    """Drive straight on for 5 s; return when it was told that the robot has turned over."""
    (robot,), told = simulation.robots, []
    for _ in range(250):
        robot.controller.command(1.0, 0.0, time_sec=simulation.time_sec)
        simulation.advance()
        recorder.append()
        told += [simulation.time_sec] if robot.turned_over else []
    return told


def test_one_that_climbs_a_barrier_aslant_turns_over_once_a_run(
    simulation: Simulation, tmp_path: Path
) -> None:
    with RunRecorder(simulation, tmp_path / FILE_NAME) as recorder:
        (told_sec,) = drive(simulation, recorder)
        simulation.reset()
        recorder.restart()
        assert drive(simulation, recorder) == [told_sec], 'after a reset, again'
    record = read_record(tmp_path)
    assert record.overturns == (Overturn(robot='husky', time_sec=told_sec),)
    begin_sec = float(record.time_sec[record.begin(0)])
    assert read_run(record).turned_over_sec == pytest.approx(told_sec - begin_sec)
    assert record.since_first_command().overturns[0].time_sec == pytest.approx(
        told_sec - begin_sec
    )


@pytest.mark.parametrize(('inclined_deg', 'is_over'), [(0, 0), (60, 0), (80, 1), (180, 1)])
@pytest.mark.parametrize('axis_deg', [0, 50, 90, 270])
def test_it_has_turned_over_whatever_it_rolled_about(
    inclined_deg: int, is_over: int, axis_deg: int
) -> None:
    half, axis = math.radians(inclined_deg) / 2.0, math.radians(axis_deg)
    tilt = (math.cos(half), math.sin(half) * math.cos(axis), math.sin(half) * math.sin(axis), 0.0)
    zero = (0.0, 0.0, 0.0)
    assert RobotState(zero, tilt, zero, zero).is_turned_over == is_over
