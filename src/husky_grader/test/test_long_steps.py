# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A grader does not hang while a step runs, however much time its watch over programs takes."""

from pathlib import Path

from husky_grader.jail import find_sandbox
from husky_grader.lab.lab import grade_lab
from husky_grader.rubric.rubric_file import parse_rubric
from husky_grader.rubric.steps import Step
import pytest

MANIFEST = """<package format="3">
  <name>p</name>
  <version>0.0.0</version>
  <description>It sleeps</description>
  <maintainer email="somebody@example.org">Somebody</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>cmake</build_type></export>
</package>"""
CMAKE = """
cmake_minimum_required(VERSION 3.8)
project(p NONE)
install(PROGRAMS sleeper DESTINATION lib/p)
"""
RUBRIC = """
title: T
steps:
  - {kind: build, points: 10}
  - {kind: publisher, points: 10, package: p, executable: sleeper, topic: t,
     type: std_msgs/msg/String}
  - {kind: drive, points: 10, package: p, executable: sleeper, courses: [{file: course.yaml}]}
"""


@pytest.mark.timeout(60)
def test_a_job_is_alive_amid_each_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / 'workspace' / 'src' / 'p'
    package.mkdir(parents=True)
    for name, text in {
        'package.xml': MANIFEST,
        'CMakeLists.txt': CMAKE,
        'sleeper': '#!/bin/sh\nsleep 2\n',
    }.items():
        (package / name).write_text(text)
    (package / 'sleeper').chmod(0o755)
    (tmp_path / 'course.yaml').write_text('waypoints: [[0, 0], [-2, 0]]\n')
    monkeypatch.setattr('husky_grader.lab.build_step.LOOK_SEC', 0.05)
    calls: list[None] = []
    amid: dict[str, int] = {}

    def done(step: Step) -> None:
        amid[step.name] = len(calls)
        calls.clear()

    steps = grade_lab(
        tmp_path / 'workspace',
        parse_rubric(RUBRIC, str(tmp_path / 'rubric.yaml')),
        tmp_path / 'report',
        sandbox=find_sandbox('none'),
        done=done,
        alive=lambda: calls.append(None),
    )
    assert [step.points for step in steps] == [10.0, 0.0, 0.0], steps
    # Once is after the step before.
    assert {name: count > 1 for name, count in amid.items()} == dict.fromkeys(amid, True), amid
    assert [*amid] == ['build', 'publisher', 'drive']
