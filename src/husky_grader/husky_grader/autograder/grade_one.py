# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade what one student has handed in, and write the result as the place wants it.

`./lab exec python3 -m husky_grader.autograder.grade_one --for gradescope FOLDER --result FILE`
"""

import argparse
from collections.abc import Sequence
import json
from pathlib import Path
import sys
import time
from typing import Any

from husky_course.files import replacing
from husky_course.printable import printable
from husky_runtime.command_line import BAD_INPUT, Parser

from husky_grader.autograder.classroom50 import classroom_result
from husky_grader.autograder.gradescope import gradescope_results, wrong_points
from husky_grader.jail import find_sandbox
from husky_grader.lab.drive_step import drive_folders
from husky_grader.lab_grading import grade_submission
from husky_grader.playpen import default_rubric
from husky_grader.rubric.rubric_file import load_rubric
from husky_grader.rubric.steps import DriveStep, Rubric, Step
from husky_grader.submission import Submission

PLACES = ('gradescope', 'classroom50')


def main(args: Sequence[str] | None = None) -> int:
    """Grade it; return an exit code that says only whether there is a result."""
    parser = Parser(prog='grade_one', description=__doc__, allow_abbrev=False)
    parser.add_argument('submission', type=Path, help='the folder that was handed in')
    parser.add_argument('--for', dest='place', choices=PLACES, required=True)
    parser.add_argument('--result', type=Path, required=True, help='the file to write')
    parser.add_argument('--rubric', type=Path, help='that of the lab sheet where left out')
    parser.add_argument('--report', type=Path, default=Path('report'))
    parser.add_argument('--metadata', type=Path, help='what Gradescope tells of the submission')
    parser.add_argument('--sandbox', default='auto')
    options = parser.parse_args(args)
    try:
        content = _graded(options)
        with replacing(options.result) as part:
            part.write_text(json.dumps(content, indent=2) + '\n', encoding='utf-8')
    except (ValueError, OSError) as error:
        print(printable(str(error), keep='\n'), file=sys.stderr)
        return BAD_INPUT
    return 0


def _graded(options: argparse.Namespace) -> dict[str, Any]:
    begun_sec = time.monotonic()
    rubric = load_rubric(options.rubric or default_rubric())
    if options.metadata and (wrong := wrong_points(options.metadata, rubric)):
        print(wrong, flush=True)
    sandbox = None if rubric.is_of_files else find_sandbox(options.sandbox)
    folder = options.report
    _make_private_folders(rubric, folder)
    source = options.submission.resolve()
    graded = grade_submission(
        Submission(source.name, source, 'folder'),
        rubric,
        folder,
        sandbox=sandbox,
        done=_tell,
    )
    if options.place == 'classroom50':
        return classroom_result(graded)
    took_sec = time.monotonic() - begun_sec
    return gradescope_results(graded, rubric, folder, took_sec=took_sec)


def _make_private_folders(rubric: Rubric, folder: Path) -> None:
    """Make the folders of drives: a program that is only another user could read its true pose."""
    folder.mkdir(parents=True, exist_ok=True)
    for step in rubric.steps:
        if isinstance(step, DriveStep):
            for _, place in drive_folders(step, folder):
                place.mkdir(parents=True, exist_ok=True)
                place.chmod(0o700)


def _tell(step: Step) -> None:
    print(printable(f'{step.name}: done'), flush=True)


if __name__ == '__main__':
    sys.exit(main())
