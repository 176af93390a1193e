# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A program whose first line names nothing that can be started is told why."""

from dataclasses import replace
import os
from pathlib import Path

from husky_grader.jail import find_sandbox
from husky_grader.lab.drive_step import drive_step, DriveRunner
from husky_grader.lab.live_steps import live_step
from husky_grader.lab.programs import Programs
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import CourseToDrive, DriveStep, PublisherStep
import pytest

(PUBLISHES,) = (
    step for step in load_rubric(default_rubric()).steps if isinstance(step, PublisherStep)
)
SAVE, ENV = 'save it as UTF-8 without one', '#!/usr/bin/env python3'
ON_WINDOWS = 'its lines end as on Windows (CRLF); save it with those of Linux (LF)'


def built(folder: Path, package: str, executable: str, first_line: str) -> Programs:
    """Write a program where a build puts it."""
    manifest = folder / 'workspace' / 'src' / package / 'package.xml'
    manifest.parent.mkdir(parents=True)
    manifest.write_text(f'<package><name>{package}</name></package>')
    program = folder / 'built' / 'install' / package / 'lib' / package / executable
    program.parent.mkdir(parents=True)
    program.write_bytes(f'{first_line}import rclpy\r\n'.encode())
    program.chmod(0o755)
    return Programs(manifest.parents[2], folder / 'built', os.environ, find_sandbox('none'))


@pytest.mark.parametrize(
    ('first_line', 'why'),
    [
        ('#!/usr/bin/env no_such_python\n', 'there is no such program as its first line says'),
        ('#!/usr/bin/env python3\r\n', ON_WINDOWS),
        ('#!/usr/bin/python3\r\n', ON_WINDOWS),
        ('\ufeff#!/usr/bin/env python3\n', f'it begins with a byte order mark; {SAVE}'),
        ('import sys\n', f'its first line has to say by what it runs: {ENV}'),
        ('', f'its first line has to say by what it runs: {ENV}'),
    ],
)
def test_a_program_that_cannot_be_started_is_told_why(
    tmp_path: Path, first_line: str, why: str
) -> None:
    programs = built(tmp_path, PUBLISHES.package, 'publisher', first_line)
    found = live_step(replace(PUBLISHES, within_sec=3.0), programs, tmp_path / 'log')
    assert found.why == f'publisher cannot be started: {why}'


@pytest.mark.timeout(60)
def test_a_driver_that_cannot_be_started_is_told_why(tmp_path: Path) -> None:
    programs = built(tmp_path, 'my_driver', 'follow_path', '#!/usr/bin/env python3\r\n')
    (course := tmp_path / 'course.yaml').write_text('waypoints: [[0, 0], [-2, 0]]\n')
    step = DriveStep(
        points=10,
        name='drive',
        package='my_driver',
        executable='follow_path',
        courses=(CourseToDrive(file=course),),
    )
    found = drive_step(step, DriveRunner(programs), tmp_path / 'report')
    assert found.why.startswith(f'follow_path cannot be started: {ON_WINDOWS}; ')
