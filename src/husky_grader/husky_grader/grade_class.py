# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Grade a class: many waypoint files, or what was handed in for a lab."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import json
import os
from pathlib import Path
import sys
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, TypeVar

from husky_course.printable import printable
from husky_runtime.command_line import BAD_INPUT

from husky_grader.batch.shards import parse_shard
from husky_grader.playpen import default_rubric
from husky_grader.tally import Tally

if TYPE_CHECKING:  # they take their time
    from husky_grader.batch.job import Job, Outcome
    from husky_grader.jail import Sandbox
    from husky_grader.outputs import Gradebook
    from husky_grader.rubric.steps import Rubric
    from husky_grader.submission import Submission

PASSED, NOT_PASSED = 0, 1
AJob = TypeVar('AJob', bound='Job')
# Parts lists of folders; begin and end variables of setuptools; end names in scripts of shells.
_NOT_BUILT_IN = ':${}"`*'
FEW_FILES = 8  # so many are told by their names


def wrong_of_class(options: argparse.Namespace) -> str:
    """Return what is wrong with the options that only a class has; nothing if they are right."""
    one_run = options.record or options.controller
    for option in ('shard', 'collect', 'executor'):
        if getattr(options, option) and one_run:
            return f'--{option} is for a class: give waypoint files, or --lab SUBMISSION...'
    if options.gradebook and not options.lab:
        return '--gradebook is for what was handed in: give --lab SUBMISSION...'
    if options.gradebook and options.shard:
        return '--gradebook needs the whole class: give it with --collect, or without --shard'
    if options.shard and options.collect:
        return '--shard grades a share, --collect puts shares together; give one of them'
    if options.executor:
        from husky_grader.batch.dask_cluster import ADDRESS

        if not options.executor.startswith(ADDRESS):
            return f'--executor {options.executor}: give {ADDRESS}tcp://HOST:PORT, or leave it out'
    if options.shard:
        try:
            parse_shard(options.shard)
        except ValueError as error:
            return str(error)
    missing = [folder for folder in options.collect if not Path(folder).is_dir()]
    if missing:
        return f'--collect {missing[0]}: no such folder; give the --report of other calls'
    return ''


def is_of_a_class(options: argparse.Namespace) -> bool:
    """Tell whether options are given that only a class has, and be it a class of one."""
    return bool(options.shard or options.collect or options.executor or options.gradebook)


def grade_files(options: argparse.Namespace) -> int:
    """Grade waypoint files; return the exit code."""
    from husky_grader.batch.tables import names_of, table, write_csv
    from husky_grader.file_job import FileJob

    folder = Path(options.report)
    _make_folder(folder)
    files = _places(options.files, options)
    every = [
        FileJob(file, name, options.world)
        for file, name in zip(files, names_of(files), strict=True)
    ]
    jobs = parse_shard(options.shard or '1/1').of(every)
    outcomes, unsealed = _done(
        jobs,
        folder,
        options,
        lambda job, outcome: f'{job.name} {job.grade(outcome).score:.1f}',
        at_a_time=options.jobs,
    )
    grades = [job.grade(outcome) for job, outcome in zip(jobs, outcomes, strict=True)]
    if options.json:
        entries = [
            {'file': grade.file, 'refused': grade.refused or None, 'report': grade.report}
            for grade in grades
        ]
        print(json.dumps(entries, indent=2))
    else:
        print(table([job.name for job in jobs], grades))
    lost = [grade.refused for grade in grades if grade.undone]
    try:
        write_csv(folder / 'grades.csv', grades)
    except OSError as error:
        lost.append(f'grades.csv: {error.strerror}')
    if _tell_lost(folder, lost, unsealed):
        return BAD_INPUT
    if not options.json:
        print(printable(f'grades: {folder / "grades.csv"}'))
    return PASSED if all(grade.passed for grade in grades) else NOT_PASSED


def grade_labs(options: argparse.Namespace) -> int:
    """Grade what was handed in for a lab; return the exit code."""
    from husky_grader.jail import find_sandbox, NoSandbox
    from husky_grader.outputs import OUTPUT_FILES, read_gradebook
    from husky_grader.rubric.impossible import impossible_courses
    from husky_grader.rubric.rubric_file import load_rubric
    from husky_grader.submission import find_submissions

    rubric = load_rubric(options.rubric or default_rubric())
    for line in impossible_courses(rubric):
        _tell(line)
    report = os.path.realpath(options.report)  # not Path.resolve: links may lead in a circle
    given = _places(options.lab, options)
    # It is none of what was handed in: the next call finds the same.
    without = '' if report in map(os.path.realpath, given) else report
    submissions = find_submissions(given, taken=OUTPUT_FILES, without=without)
    _check_report(submissions, options, builds=not rubric.is_of_files)
    gradebook = None
    if options.gradebook:
        gradebook = read_gradebook(Path(options.gradebook), submissions, title=rubric.title)
    sandbox = None
    try:
        sandbox = None if rubric.is_of_files else find_sandbox(options.sandbox)
    except NoSandbox:
        if not options.collect:  # what was graded elsewhere needs none here
            raise
    if sandbox is not None:
        _check_programs_run(Path(options.report))
    if _is_alone(submissions, options):
        return _grade_lab(submissions[0], rubric, sandbox, options)
    return _grade_labs(submissions, rubric, sandbox, gradebook, options)


def _check_report(
    submissions: Sequence[Submission], options: argparse.Namespace, *, builds: bool
) -> None:
    """
    Check that no report is written into what was handed in, or removes a folder of a person's.

    :raises ValueError: if one would be.
    """
    from husky_grader.submission.limits import BUILT, COPY, IGNORED

    report = os.path.realpath(options.report)
    for each in submissions:
        place = Path(report) if _is_alone(submissions, options) else Path(report, each.id)
        source = Path(os.path.realpath(each.source))
        if source == place or _is_taken(place / COPY, source):
            raise ValueError(
                f'--report {options.report}: there the report on {each.id} would lie in what was '
                'handed in; name another folder'
            )
        # Of a grading that was killed the mark in it may be gone; the copy has one all the time.
        is_new = builds and not (place / COPY / IGNORED).exists()
        if is_new and _is_taken(place / BUILT, source):
            raise ValueError(
                f'--report {options.report}: {place / BUILT} is not of the grader, which would '
                'build there and remove it; name another folder'
            )


def _is_taken(folder: Path, source: Path) -> bool:
    """Tell whether a folder for the grader is a person's, or has what was handed in."""
    from husky_grader.submission.limits import IGNORED

    return source.is_relative_to(folder) or (
        folder.is_dir() and not (folder / IGNORED).exists() and any(folder.iterdir())
    )


def _is_alone(submissions: Sequence[Submission], options: argparse.Namespace) -> bool:
    """Tell whether there is one submission, and no class."""
    return len(submissions) == 1 and not is_of_a_class(options)


def _check_programs_run(folder: Path) -> None:
    """
    Check that programs can be built in a folder and run there.

    :raises ValueError: if it cannot, for which each student would lose points.
    """
    place = os.path.realpath(folder)
    try:
        place.encode()
    except UnicodeEncodeError:
        raise ValueError(
            f'{folder}: nothing can be built in a folder whose name is not UTF-8; name another '
            'folder with --report DIR'
        ) from None
    for char in _NOT_BUILT_IN:
        if char in place:
            raise ValueError(
                f"{folder}: nothing can be built in a folder with a '{char}' in its name; name "
                'another folder with --report DIR'
            )
    folder.mkdir(parents=True, exist_ok=True)
    if os.statvfs(folder).f_flag & os.ST_NOEXEC:
        raise ValueError(
            f'{folder}: no program can run on this file system, which is mounted with noexec; '
            'name another folder with --report DIR'
        )


def _grade_lab(
    submission: Submission, rubric: Rubric, sandbox: Sandbox | None, options: argparse.Namespace
) -> int:
    """Grade one submission, and say each step that is done."""
    from husky_grader.graded import LAB_FILE
    from husky_grader.lab.lab import table as lab_table
    from husky_grader.lab_grading import grade_submission
    from husky_grader.lab_job import write_result
    from husky_grader.outputs import left_by_earlier, write_student_page

    folder = Path(options.report)
    for note in submission.notes:
        _tell(f'{submission.id}: {note}')
    graded = grade_submission(
        submission,
        rubric,
        folder,
        sandbox=sandbox,
        real_time_factor=options.real_time_factor,
        done=lambda step: _tell(f'{submission.id}: {step.name}: done'),
    )
    write_student_page(folder, graded)
    for line in left_by_earlier(folder):
        _tell(f'{folder}: {line}')
    if graded.refused:
        raise ValueError(graded.refused)
    write_result(graded, rubric, folder)
    if options.json:
        print((folder / LAB_FILE).read_text(encoding='utf-8'), end='')
    else:
        print(lab_table(graded.steps))
    return PASSED if graded.is_full else NOT_PASSED


def _grade_labs(
    submissions: Sequence[Submission],
    rubric: Rubric,
    sandbox: Sandbox | None,
    gradebook: Gradebook | None,
    options: argparse.Namespace,
) -> int:
    """Grade a class."""
    from husky_grader.lab_job import LabJob
    from husky_grader.outputs import write_outputs

    folder = Path(options.report)
    _make_folder(folder)
    name = '' if rubric.is_of_files else sandbox.name if sandbox else options.sandbox
    every = [LabJob(each, each.id, rubric, name, options.real_time_factor) for each in submissions]
    jobs = parse_shard(options.shard or '1/1').of(every)
    outcomes, unsealed = _done(
        jobs,
        folder,
        options,
        lambda job, outcome: job.graded(outcome).said(),
        at_a_time=_at_a_time(sandbox, options),
    )
    graded = [job.graded(outcome) for job, outcome in zip(jobs, outcomes, strict=True)]
    if options.json:
        print(json.dumps([each.entry() for each in graded], indent=2))
    else:
        width = max((len(each.submission.id) for each in graded), default=0)
        for each in graded:
            print(each.line(width))
    lost = [outcome.refused for outcome in outcomes if outcome.undone]
    try:
        outputs = write_outputs(folder, graded, title=rubric.title, gradebook=gradebook)
    except OSError as error:
        lost.append(f'{error.filename or "the outputs"}: {error.strerror}')
    else:
        for note in outputs.notes:
            _tell(note)
        if not options.json:
            print(printable('written: ' + ', '.join(map(str, outputs.files[:FEW_FILES]))))
    if _tell_lost(folder, lost, unsealed):
        return BAD_INPUT
    return PASSED if all(each.is_full for each in graded) else NOT_PASSED


def _at_a_time(sandbox: Sandbox | None, options: argparse.Namespace) -> int:
    """Return how many submissions to grade at a time; 0: as many as there are cores."""
    if sandbox is None or not sandbox.one_at_a_time:
        jobs: int = options.jobs
        return jobs
    if options.jobs > 1:
        _tell(
            f'--jobs {options.jobs}: one is graded at a time, because the sandbox {sandbox.name} '
            'lets programs reach those of other submissions'
        )
    return 1


def _done(
    jobs: Sequence[AJob],
    folder: Path,
    options: argparse.Namespace,
    said: Callable[[AJob, Outcome], str],
    *,
    at_a_time: int,
) -> tuple[list[Outcome], str]:
    """
    Do jobs, and count them on the terminal; return their outcomes, and why one was not sealed.

    :param said: what the terminal tells of an outcome.
    :param at_a_time: how many here; 0: as many as there are cores.
    """
    from husky_grader.batch.batch import Batch, How

    _tell_empty(options.collect)
    options.remembers = True  # what is done, where it is interrupted
    tally = Tally(len(jobs), sys.stderr, 'the workers start', bar=sys.stderr.isatty())
    batch = Batch(
        jobs,
        folder,
        how=How(options.executor, at_a_time, tuple(map(Path, options.collect))),
        done=lambda number, outcome: tally.add(
            said(jobs[number], outcome), is_new=not outcome.remembered
        ),
        not_taken=_tell_not_taken,
    )
    try:
        return batch.run(), batch.unsealed
    finally:
        tally.close()


def _tell_empty(collect: Sequence[str]) -> None:
    """Tell of folders without results, as one with the reports in its folders."""
    from husky_grader.batch.sealed import SEAL_FILE

    empty = [
        folder
        for folder in collect
        if not any((report / SEAL_FILE).exists() for report in Path(folder).iterdir())
    ]
    if empty:
        _tell(
            f'--collect: no result is in ({len(empty)}): {_few(empty)}; give what other calls had '
            'as --report DIR'
        )


def _few(names: Sequence[str]) -> str:
    return ', '.join([*names[:FEW_FILES], *(['...'] if len(names) > FEW_FILES else [])])


def _tell_not_taken(names: Sequence[str]) -> None:
    _tell(
        f'--collect: not taken, and graded here again ({len(names)}): {_few(names)}: their '
        'results were sealed with another HUSKY_GRADING_SECRET, or for other submissions, another '
        'rubric, lab, Python, MuJoCo or numpy, or have been changed since'
    )


def _make_folder(folder: Path) -> None:
    """
    Make the folder of a report.

    :raises ValueError: if nothing can be written there, for which all would be graded in vain.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        TemporaryFile(dir=folder).close()
    except OSError as error:
        raise ValueError(
            f'{folder}: nothing can be written there ({error.strerror}); name another folder with '
            '--report DIR'
        ) from None


def _places(given: Sequence[str], options: argparse.Namespace) -> list[str]:
    """Return where files lie; a worker of a cluster has another working directory."""
    return [str(Path(each).absolute()) if options.executor else each for each in given]


def _tell_lost(folder: Path, lost: Sequence[str], unsealed: str) -> bool:
    """Say in one line what could not be done; tell whether anything could not."""
    lost = [*lost, *([f'what was graded cannot be remembered: {unsealed}'] if unsealed else [])]
    if lost:
        more = f' (and {len(lost) - 1} more)' if len(lost) > 1 else ''
        room = 'make room, on the disk or in memory, then the same command does the rest'
        _tell(f'{folder}: {lost[0]}{more}; {room}')
    return bool(lost)


def _tell(line: str) -> None:
    print(printable(line), file=sys.stderr, flush=True)
