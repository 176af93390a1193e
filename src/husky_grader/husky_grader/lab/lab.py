# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade a student's whole workspace: every step of the lab sheet, with points and reasons."""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
import json
from pathlib import Path
import shutil

from husky_course.record import read_run
from husky_course.route import Route

from husky_grader.lab.file_steps import (
    build_step,
    driver_package,
    find_executable,
    package_step,
    ProgramMissing,
    sourced,
    Verdict,
    workspace_step,
)
from husky_grader.lab.graph_steps import publisher_step, subscriber_step
from husky_grader.report.files import write_report
from husky_grader.run.live import drive_live
from husky_grader.scoring.report import judge

LiveStep = Callable[[Path, dict[str, str]], Verdict]


@dataclass(frozen=True)
class Step:
    """One step of the lab: what it was worth, what it got, and what to do about the rest."""

    name: str
    most: float
    points: float
    why: str

    @property
    def is_full(self) -> bool:
        """Whether it got every point."""
        return self.points >= self.most


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

    def drive_step(_: Path, environment: dict[str, str]) -> Verdict:
        program = find_executable(folder, driver_package(workspace), 'follow_path')
        live = drive_live(
            str(program),
            route.course.file,
            folder / 'drive',
            answers=answers,
            environment=environment,
            real_time_factor=real_time_factor,
        )
        run = read_run(live.record)
        report = live.with_notes(judge(run, route))
        write_report(folder / 'drive', report, run, route)
        return report.score, '; '.join(report.reasons) or f'{report.course} passed'

    steps = []
    for name, most, (percent, why) in _verdicts(workspace, folder, drive_step):
        steps.append(Step(name, most, most * percent / 100.0, why))
        done(steps[-1])
    total = sum(step.points for step in steps)
    content = {'score': total, 'steps': [asdict(step) for step in steps]}
    (folder / 'lab.json').write_text(json.dumps(content, indent=2) + '\n', encoding='utf-8')
    return steps


def _verdicts(
    workspace: Path, folder: Path, drive_step: LiveStep
) -> Iterator[tuple[str, float, Verdict]]:
    """Yield the name of each step, its points, and what became of it."""
    driver = driver_package(workspace)
    yield 'workspace', 5.0, workspace_step(workspace)
    yield 'package topic_demo', 10.0, package_step(workspace, 'topic_demo')
    yield f'package {driver}', 5.0, package_step(workspace, driver)
    yield 'build', 15.0, build_step(workspace, folder)
    live = (
        ('publisher', 20.0, publisher_step),
        ('subscriber', 15.0, subscriber_step),
        ('drive', 30.0, drive_step),
    )
    try:
        environment = sourced(folder)
    except ValueError as error:
        yield from ((name, most, (0.0, str(error))) for name, most, _ in live)
        return
    for name, most, step in live:
        try:
            yield name, most, step(folder, environment)
        except ProgramMissing as error:
            yield name, most, (0.0, str(error))


def table(steps: list[Step]) -> str:
    """Return one line a step, and the sum."""
    lines = [
        f'{step.name:<22} {step.points:5.1f} of {step.most:4.0f}  {step.why}' for step in steps
    ]
    total, most = sum(step.points for step in steps), sum(step.most for step in steps)
    return '\n'.join([*lines, f'{"total":<22} {total:5.1f} of {most:4.0f}'])
