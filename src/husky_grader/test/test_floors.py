# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The driver learns a floor on the way: nothing tells it which one, or where the robot is."""

import math
import os
from pathlib import Path
import subprocess
import sys

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course, parse_course
from husky_driver.drive import Drive
from husky_driver.motion import Command, Odometry
from husky_grader.report.files import summary
from husky_grader.run.in_process import Conditions, drive_route, drive_with
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
    assert report.conditions == (f'floor:={floor}', 'seed:=7', 'realistic:=true')
    assert f'  driven with floor:={floor} seed:=7 realistic:=true\n' in summary(report)
    assert report.cross_track_rms_m < 0.05


@pytest.mark.parametrize('floor', ['asphalt', 'gravel'])
def test_corners_of_more_than_a_right_angle_are_turned_on_the_spot(floor: str) -> None:
    places = '[0, 0], [-1, 1], [-2, -1], [-3, 1], [-4, -1], [-5, 0.5]'
    route = plan_route(parse_course(f'speed: 0.5\nwaypoints: [{places}]'))
    # The heavier side lets a turn on the spot creep away, and the first turn knows nothing of it.
    conditions = Conditions(floor=floor, realistic=True, seed=0)
    record, drive = drive_route(route, conditions=conditions)
    report = judge(read_run(record), route)
    assert (drive.failure, report.completed) == ('', True)
    assert report.cross_track_rms_m < 0.04


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


def test_the_cpu_that_numpy_computes_for_does_not_matter() -> None:
    route = plan_route(load_course(COURSES / 'central_barrier.yaml'))
    conditions = Conditions(floor='grass', realistic=True, seed=0)
    here = judge(read_run(drive_route(route, conditions=conditions)[0]), route)
    program = (
        'from husky_course.record import read_run; from husky_course.route import plan_route; '
        'from husky_course.waypoints import load_course; '
        'from husky_grader.run.in_process import Conditions, drive_route; '
        f'route = plan_route(load_course({str(COURSES / "central_barrier.yaml")!r})); '
        f'print(read_run(drive_route(route, conditions={conditions})[0]).trajectory_sha256)'
    )
    # As on an old one: products of numpy's matrices have other last digits there.
    old = {**os.environ, 'OPENBLAS_CORETYPE': 'Nehalem', 'PYTHONPATH': ':'.join(sys.path)}
    there = subprocess.run(
        [sys.executable, '-c', program], env=old, capture_output=True, text=True, timeout=60.0
    )
    assert there.stdout.split() == [here.trajectory_sha256], there.stderr


def test_a_drive_that_goes_over_to_another_file_knows_its_place() -> None:
    first = Drive(plan_route(load_course(COURSES / 'central_barrier.yaml')))
    then = Drive(plan_route(load_course(COURSES / 'slalom.yaml')), before=first)
    places = []

    def controller(odometry: Odometry) -> Command | None:
        drive = first if odometry.time_sec < 12.0 else then
        command = drive.step(odometry)
        assert drive.odometry is not None
        places.append((drive.odometry[1:3], odometry[1:3]))
        return command if drive is first else None

    conditions = Conditions(floor='grass', realistic=True, seed=3)
    drive_with(controller, on_imu=first.add_imu, conditions=conditions)
    (before, _), (now, by_odometry) = places[-2:]
    assert math.dist(before, now) < 0.03  # in 0.02 s
    assert math.dist(before, by_odometry) > 0.06
