# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import cast

from husky_grader.lab.drive_step import drive_step, DriveRunner
from husky_grader.rubric.steps import CourseToDrive, DriveStep
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
