# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The step in which a program drives courses."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
import shlex
import shutil

from husky_course.record import read_run
from husky_course.route import plan_route
from husky_course.waypoints import load_course

from husky_grader.graded import DRIVE_PASSED
from husky_grader.lab.finding import Finding
from husky_grader.lab.hiding import hiding
from husky_grader.lab.misplaced import misplaced
from husky_grader.lab.programs import Programs, wrong_first_line
from husky_grader.report.files import write_report
from husky_grader.rubric.steps import COURSE, CourseToDrive, DriveLimits, DriveStep
from husky_grader.run.diagnosis import crash
from husky_grader.run.live import drive_live
from husky_grader.scoring.reasons import disturbed_by
from husky_grader.scoring.report import digits_apart, judge, Report

COURSE_FILE = 'course.yaml'
LEAST = 0.05  # points that are worth a word
FOR_STAFF = 'staff'
"""The folder, in a report, of what students must not see: the drives of hidden courses."""


@dataclass(frozen=True)
class DriveRunner:
    """Runs a program with the simulator; `alive` is called about twice a second."""

    programs: Programs
    real_time_factor: float = 1.0
    alive: Callable[[], object] = lambda: None

    def drive(self, step: DriveStep, course: CourseToDrive, folder: Path) -> Report:
        """Let a program drive a course, and write the report on it into a folder."""
        route = plan_route(load_course(course.file))
        command = self.programs.command_of(step)
        with self.programs.jail() as jail:
            lent = shutil.copyfile(course.file, jail.folder / COURSE_FILE)
            lent.chmod(0o644)
            given = str(lent)
            live = drive_live(
                shlex.join(part.replace(COURSE, given) for part in command),
                str(course.file),
                folder,
                jail,
                world=self.programs.world,
                answers=''.join(f'{answer.replace(COURSE, given)}\n' for answer in step.answers),
                environment=self.programs.environment,
                without=self.programs.place,
                real_time_factor=self.real_time_factor,
                on_progress=lambda _told: self.alive(),
            )
        if step.executable and (wrong := wrong_first_line(Path(command[0]))):
            live = replace(live, notes=(f'{step.executable} cannot be started: {wrong}',))
        else:
            error = crash(live.printed)
            hint = hiding(error, self.programs.built, self.programs.environment)
            hint = hint or misplaced(error, self.programs.workspace)
            live = replace(live, notes=(*live.notes, *filter(None, [hint])))
        run = read_run(live.record)
        report = live.with_notes(judge(run, route))
        if course.title:
            report = replace(report, course=course.title)
        write_report(folder, report, run, route)
        return report


def drive_step(step: DriveStep, runner: DriveRunner, folder: Path) -> Finding:
    """
    Let a program drive every course of a step.

    :param folder: of the whole report; each drive gets a folder of its own in it.
    :raises PackageMissing: when the package is not there.
    :raises ProgramMissing: when the program is not there.
    """
    whole = sum(course.share for course in step.courses)
    score, lines = 0.0, []
    for course, place in drive_folders(step, folder):
        report = runner.drive(step, course, place)
        over = exceeded(
            step.limits,
            collisions=len(report.collisions),
            off_path_m=report.cross_track_rms_m,
            time_sec=report.sim_time_sec,
        )
        cost = sum(map(step.cost_percent, over))
        score += max(report.score - cost, 0.0) * course.share / whole
        reasons = _numbers(report) if course.hidden else report.reasons
        told = _disturbed(report, course) or '; '.join([*over.values(), *reasons])
        one = f'{report.course}: {told}' if len(step.courses) > 1 or course.hidden else told
        costs = {part.why: part.cost_points for part in report.parts}
        lines.append(one if told else passed(report.course, costs))
    # A sum of shares may be off in its last digit, and all points would not be all.
    return Finding('; '.join(lines), score=round(score, 9))


def _disturbed(report: Report, course: CourseToDrive) -> str:
    """Return who disturbed a run: all else in it says nothing, and is never the same."""
    found = [disturbed_by(each, names_nodes=not course.hidden) for each in report.disturbances]
    return '; '.join(dict.fromkeys(found))


def drive_folders(step: DriveStep, folder: Path) -> list[tuple[CourseToDrive, Path]]:
    """Return the courses, each with the folder of the report on its drive."""
    found = []
    for number, course in enumerate(step.courses, 1):
        name = step.file_name if len(step.courses) == 1 else f'{step.file_name}_{number}'
        found.append((course, folder / FOR_STAFF / name if course.hidden else folder / name))
    return found


def passed(course: str, costs: Mapping[str, float]) -> str:
    """
    Return what is said of a drive that is passed.

    :param costs: points that it lost, by the reasons.
    """
    lost = [f'{why} costs {points:.1f} points' for why, points in costs.items() if points > LEAST]
    return '; '.join([f'{course}{DRIVE_PASSED}', *lost])


def exceeded(
    limits: DriveLimits, *, collisions: int, off_path_m: float, time_sec: float
) -> dict[str, str]:
    """
    Return which limits a drive has exceeded, and by what.

    :param off_path_m: root of the mean square.
    """
    found = {}
    time_sec = round(time_sec, 6)  # of 60 s the difference of two times may be a hair more
    if limits.collisions is not None and collisions > limits.collisions:
        noun = 'collision' if collisions == 1 else 'collisions'
        found['collisions'] = f'{collisions} {noun}, {limits.collisions:g} are allowed'
    if limits.off_path_m is not None and off_path_m > limits.off_path_m:
        digits = digits_apart(off_path_m, limits.off_path_m, least=3)
        found['off_path_m'] = (
            f'{off_path_m:.{digits}f} m RMS off the path, {limits.off_path_m:g} m are allowed'
        )
    if limits.time_sec is not None and time_sec > limits.time_sec:
        digits = digits_apart(time_sec, limits.time_sec, least=1)
        found['time_sec'] = f'{time_sec:.{digits}f} s, {limits.time_sec:g} s are allowed'
    return found


def _numbers(report: Report) -> tuple[str, ...]:
    """Return what may be told of a hidden course: nothing that tells where it goes."""
    touches = len(report.collisions)
    return (
        f'score {report.score:.1f} of 100, {report.waypoints_reached} of '
        f'{report.waypoints_total} waypoints, {touches} collision{"" if touches == 1 else "s"}',
    )
