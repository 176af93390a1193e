# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The driver learns a floor on the way: nothing tells it which one, or where the robot is."""

from pathlib import Path

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course
from husky_grader.run.in_process import Conditions, drive_route
from husky_grader.scoring.report import judge
import pytest

COURSES = Path(__file__).resolve().parents[3] / 'config' / 'waypoints'


@pytest.mark.parametrize('floor', ['concrete_indoor', 'wet', 'gravel', 'grass'])
def test_the_barrier_is_rounded_with_noise_and_unequal_loads(floor: str) -> None:
    route = plan_route(load_course(COURSES / 'central_barrier.yaml'))
    record, drive = drive_route(route, conditions=Conditions(floor=floor, realistic=True, seed=7))
    report = judge(read_run(record), route)
    assert (drive.failure, report.collisions) == ('', ())
    assert report.completed
    assert report.cross_track_rms_m < 0.05


def test_the_same_seed_gives_the_same_run_and_another_one_another() -> None:
    route = plan_route(load_course(COURSES / 'straight.yaml'))
    hashes = [
        judge(read_run(drive_route(route, conditions=given)[0]), route).trajectory_sha256
        for given in (
            Conditions(floor='grass', realistic=True, seed=3),
            Conditions(floor='grass', realistic=True, seed=3),
            Conditions(floor='grass', realistic=True, seed=4),
            Conditions(floor='grass'),
        )
    ]
    assert hashes[0] == hashes[1]
    assert len(set(hashes)) == 3
