# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade a student's whole workspace: every step of the lab sheet, with points and reasons."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict
import json
from pathlib import Path
import shutil

from husky_course.record import read_run
from husky_course.route import Route

from husky_grader.lab.file_steps import (
    build_step,
    driver_package,
    failed,
    find_executable,
    package_step,
    sourced,
    Step,
    workspace_step,
)
from husky_grader.lab.graph_steps import publisher_step, subscriber_step
from husky_grader.report.files import write_report
from husky_grader.run.live import drive_live
from husky_grader.scoring.report import judge

LiveStep = Callable[[Path, dict[str, str], float], Step]

POINTS = {
    **{'workspace': 5.0, 'topic_demo': 10.0, 'driver': 5.0, 'build': 15.0},
    **{'publisher': 20.0, 'subscriber': 15.0, 'drive': 30.0},
}


def grade_lab(
    workspace: Path,
    route: Route,
    folder: Path,
    *,
    answers: str = '',
    real_time_factor: float = 1.0,
    done: Callable[[Step], None] = lambda _step: None,
) -> list[Step]:
    """Grade step after step; a step that cannot be tried for want of another gets nothing."""
    folder = folder.resolve()
    shutil.rmtree(folder / 'install', ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    workspace = workspace.resolve()

    def drive_step(_: Path, environment: dict[str, str], most: float) -> Step:
        package = driver_package(workspace)
        return _drive_step(package, route, folder, environment, answers, real_time_factor, most)

    steps = []
    for step in _steps(workspace, folder, drive_step):
        steps.append(step)
        done(step)
    total = sum(step.points for step in steps)
    content = {'score': total, 'steps': [asdict(step) for step in steps]}
    (folder / 'lab.json').write_text(json.dumps(content, indent=2) + '\n', encoding='utf-8')
    return steps


def _steps(workspace: Path, folder: Path, drive_step: LiveStep) -> Iterator[Step]:
    yield workspace_step(workspace, POINTS['workspace'])
    yield package_step(workspace, 'topic_demo', POINTS['topic_demo'])
    yield package_step(workspace, driver_package(workspace), POINTS['driver'])
    yield build_step(workspace, folder, POINTS['build'])
    live = {'publisher': publisher_step, 'subscriber': subscriber_step, 'drive': drive_step}
    try:
        environment = sourced(folder)
    except ValueError as error:
        yield from (failed(name, POINTS[name], str(error)) for name in live)
        return
    for name, step in live.items():
        yield step(folder, environment, POINTS[name])


def _drive_step(
    package: str,
    route: Route,
    folder: Path,
    environment: dict[str, str],
    answers: str,
    real_time_factor: float,
    most: float,
) -> Step:
    try:
        program = find_executable(folder, package, 'follow_path')
    except ValueError as error:
        return failed('drive', most, str(error))
    live = drive_live(
        str(program),
        route,
        folder / 'drive',
        answers=answers,
        environment=environment,
        real_time_factor=real_time_factor,
    )
    run = read_run(live.record)
    report = live.with_notes(judge(run, route))
    write_report(folder / 'drive', report, run, route)
    why = '; '.join(report.reasons) if report.reasons else f'{report.course} passed'
    return Step('drive', most, most * report.score / 100.0, why)


def table(steps: list[Step]) -> str:
    """Return one line a step, and the sum."""
    lines = [
        f'{step.name:<22} {step.points:5.1f} of {step.most:4.0f}  {step.why}' for step in steps
    ]
    total, most = sum(step.points for step in steps), sum(step.most for step in steps)
    return '\n'.join([*lines, f'{"total":<22} {total:5.1f} of {most:4.0f}'])
