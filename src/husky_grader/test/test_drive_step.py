# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import cast

from husky_grader.lab.drive_step import drive_step, DriveRunner, exceeded
from husky_grader.rubric.steps import CourseToDrive, DriveLimits, DriveStep
import pytest

PERFECT = SimpleNamespace(
    **{'course': 'c', 'score': 100.0, 'parts': (), 'reasons': (), 'disturbances': ()},
    **{'collisions': (), 'cross_track_rms_m': 0.01, 'sim_time_sec': 9.0},
)


@pytest.mark.parametrize('shares', [(50, 30, 15), (1, 4, 1), (1,) * 12])
def test_drives_without_fault_get_all_points(tmp_path: Path, shares: Sequence[float]) -> None:
    courses = [CourseToDrive(file=Path('c.yaml'), share=share) for share in shares]
    step = DriveStep(points=10, name='drive', executable='go', courses=tuple(courses))
    drives = cast(DriveRunner, SimpleNamespace(drive=lambda *_: PERFECT))
    assert drive_step(step, drives, tmp_path).score == 100.0


def test_what_exceeds_a_limit_is_told_above_it() -> None:
    limits = DriveLimits(off_path_m=0.1, time_sec=60.0)
    assert exceeded(limits, collisions=0, off_path_m=0.10004, time_sec=60.02) == {
        'off_path_m': '0.10004 m RMS off the path, 0.1 m are allowed',
        'time_sec': '60.02 s, 60 s are allowed',
    }
    for collisions, said in (
        (1, '1 collision, 0 are allowed'),
        (2, '2 collisions, 0 are allowed'),
    ):
        found = exceeded(
            DriveLimits(collisions=0), collisions=collisions, off_path_m=0, time_sec=0
        )
        assert found == {'collisions': said}


def test_a_drive_of_the_very_time_that_is_allowed_is_in_time() -> None:
    taken_sec = 3015 * 0.02 - 15 * 0.02
    assert taken_sec > 60.0
    limits = DriveLimits(time_sec=60.0)
    assert exceeded(limits, collisions=0, off_path_m=0.0, time_sec=taken_sec) == {}
