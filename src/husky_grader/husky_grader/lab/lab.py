# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade a student's whole workspace: every step of a rubric, with points and reasons."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import gettempdir

from husky_course.printable import printable
from husky_runtime.domains import DomainError

from husky_grader.graded import StepGrade
from husky_grader.jail import Jail, NoSandbox, remove, Sandbox
from husky_grader.lab.build_step import build_step, sourced
from husky_grader.lab.drive_step import drive_step, DriveRunner
from husky_grader.lab.file_steps import package_step, workspace_step
from husky_grader.lab.finding import Finding, nothing
from husky_grader.lab.live_steps import live_step
from husky_grader.lab.path_step import path_step
from husky_grader.lab.programs import Programs, remove_running
from husky_grader.lab.room import check_room
from husky_grader.rubric.steps import (
    BuildStep,
    DriveStep,
    PackageStep,
    PathStep,
    ProgramStep,
    Rubric,
    Step,
    WorkspaceStep,
)
from husky_grader.run.diagnosis import shortened
from husky_grader.run.live import SimulatorNotStarted
from husky_grader.run.printed import read_printed, shown, without_machine
from husky_grader.run.standstill import undisturbed
from husky_grader.submission.limits import BUILT, IGNORED

MAX_WHY = 1000  # characters
_OF_THE_COMPUTER = (NoSandbox, DomainError, SimulatorNotStarted)


def grade_lab(
    workspace: Path,
    rubric: Rubric,
    folder: Path,
    *,
    sandbox: Sandbox,
    real_time_factor: float = 1.0,
    done: Callable[[Step], None] = lambda _step: None,
    alive: Callable[[], object] = lambda: None,
) -> list[StepGrade]:
    """
    Grade step after step; a step that cannot be tried for want of another gets nothing.

    :param folder: of the report.
    :param sandbox: in which what students wrote is built and run.
    :param done: called after each step.
    :param alive: called now and then, also amid a step.
    :raises ValueError: when the computer fails before a program of the student's has run.
    :raises OSError: when something is written, or may have failed, where there is no room.
    """
    workspace, folder = workspace.resolve(), folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    remove(folder / BUILT)
    remove_running(folder)
    findings = {}
    grading = _Grading(workspace, folder, sandbox, rubric, real_time_factor, alive)
    try:
        for step in rubric.steps:
            findings[step.name] = grading.find(step)
            done(step)
            alive()
    finally:
        remove(folder / BUILT)  # whatever a build has left is nothing for a report
    return list(_with_needs(rubric.steps, findings))


def grade_path(
    file: Path, rubric: Rubric, folder: Path, *, done: Callable[[], object] = lambda: None
) -> list[StepGrade]:
    """
    Grade a waypoint file, by a rubric for such files.

    :param folder: of the report.
    :param done: called with every second of simulated time.
    """
    folder.mkdir(parents=True, exist_ok=True)
    findings = {
        step.name: path_step(step, file, folder, world=rubric.world, alive=done)
        for step in rubric.steps
        if isinstance(step, PathStep)
    }
    return list(_with_needs(rubric.steps, findings))


class _Grading:
    """Finds out about the steps, in their order: the programs run when the workspace was built."""

    def __init__(
        self,
        workspace: Path,
        folder: Path,
        sandbox: Sandbox,
        rubric: Rubric,
        real_time_factor: float,
        alive: Callable[[], object],
    ) -> None:
        self._workspace = workspace
        self._folder = folder
        self._sandbox = sandbox
        self._rubric = rubric
        self._real_time_factor = real_time_factor
        self._alive = alive
        self._programs: Programs | None = None
        self._not_sourced = 'nothing was built'

    def find(self, step: Step) -> Finding:
        """
        Return the finding on a step, with what was printed meanwhile.

        :raises OSError: when it may have lost points for want of room on a disk.
        """
        log = self._folder / f'{step.file_name}.log'
        found = undisturbed(lambda: self._found(step, log))
        if isinstance(step, (BuildStep, ProgramStep)) and (found.defects or found.score < 100.0):
            check_room(self._folder, Path(gettempdir()))
        # Where the grader keeps what was handed in is nobody's business, and nowhere the same.
        place = f'{self._folder}/'
        printed = shown(read_printed(log, without=place))
        defects = {name: _of_nowhere(why, place) for name, why in found.defects.items()}
        why = _of_nowhere(found.why, place)
        return replace(found, why=why, defects=defects, printed=printed)

    def _found(self, step: Step, log: Path) -> Finding:
        log.unlink(missing_ok=True)  # that of a former try
        if isinstance(step, WorkspaceStep):
            return workspace_step(step, self._workspace)
        if isinstance(step, PackageStep):
            return package_step(step, self._workspace)
        if isinstance(step, BuildStep):
            return self._build(log)
        if isinstance(step, ProgramStep):
            return self._run(step, log)
        raise TypeError(f'{step.kind}: a step of this kind cannot be graded')

    def _build(self, log: Path) -> Finding:
        built = self._folder / BUILT
        built.mkdir(exist_ok=True)
        (built / IGNORED).touch()  # it stays where this is killed
        asked, readable = self._rubric.packages, [self._workspace]
        with Jail(self._sandbox, built, readable=readable, without=asked) as jail:
            found = build_step(self._workspace, jail, log, alive=self._alive)
            try:
                self._programs = Programs(
                    self._workspace,
                    built,
                    sourced(jail),
                    self._sandbox,
                    self._rubric.interfaces,
                    self._rubric.world,
                    asked,
                )
            except ValueError as error:
                self._programs, self._not_sourced = None, str(error)
        return found

    def _run(self, step: ProgramStep, log: Path) -> Finding:
        if self._programs is None:
            return nothing(self._not_sourced)
        try:
            if isinstance(step, DriveStep):
                drives = DriveRunner(self._programs, self._real_time_factor, self._alive)
                return drive_step(step, drives, self._folder)
            return live_step(step, self._programs, log, alive=self._alive)
        except _OF_THE_COMPUTER:  # no program of the student's has run yet
            raise
        except ValueError as error:  # it costs this step, not the others
            return nothing(str(error))


def _of_nowhere(why: str, place: str) -> str:
    return without_machine(why.replace(place, ''))


def _with_needs(steps: Sequence[Step], findings: Mapping[str, Finding]) -> Iterator[StepGrade]:
    """Yield the grades; a step that lacks what it needs gets nothing."""
    percents = {step.name: _percent(step, findings[step.name]) for step in steps}
    by_name = {step.name: step for step in steps}

    def counts(name: str) -> bool:
        return percents[name] > 0.0 and not lacks(by_name[name])

    def lacks(step: Step) -> str:
        missing = [name for name in step.needs if not counts(name)]
        if missing:
            return f'counts only with points for {" and ".join(missing)}'
        if step.needs_one_of and not any(map(counts, step.needs_one_of)):
            return f'counts only with points for {" or ".join(step.needs_one_of)}'
        return ''

    for step in steps:
        found, lacking = findings[step.name], lacks(step)
        points = 0.0 if lacking else step.points * percents[step.name] / 100.0
        told = list(found.defects.values()) or [found.why]
        if lacking and percents[step.name] > 0.0:
            told.insert(0, lacking)
        why = shortened('; '.join(told), MAX_WHY)
        yield StepGrade(step.name, step.points, points, why, found.printed)


def _percent(step: Step, found: Finding) -> float:
    return max(found.score - sum(map(step.cost_percent, found.defects)), 0.0)


def table(grades: Sequence[StepGrade]) -> str:
    """Return one line a step, and the sum."""
    width = max(len(grade.name) for grade in grades)
    lines = [
        f'{grade.name:<{width}} {grade.points:5.1f} of {grade.most:4g}  {grade.why}'
        for grade in grades
    ]
    total, most = sum(grade.points for grade in grades), sum(grade.most for grade in grades)
    lines.append(f'{"total":<{width}} {total:5.1f} of {most:4g}')
    return '\n'.join(map(printable, lines))
