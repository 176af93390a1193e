# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Grade a submission in Classroom 50: fetch the lab, grade what was checked out, leave result.json.

It goes to CLASSROOM/autograders/ASSIGNMENT/autograder.py; a file rubric.yaml beside it, with its
courses, takes the place of the lab sheet's rubric. See docs/autograders.md. Any exit status but 0
says that the grading itself failed.
"""

import os
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile

LAB_URL = 'https://github.com/your-organisation/husky_playpen_lab.git'  # fill in
LAB_TAG = 'v0.1.0'  # fill in: so that all are graded alike
RESULT = Path('result.json')  # in the student's checkout, where this starts
RESTRICTED = Path('/proc/sys/kernel/apparmor_restrict_unprivileged_userns')


def fetched_lab(folder: Path) -> Path:
    """Return the lab: the one in $HUSKY_LAB, or a clone."""
    if given := os.environ.get('HUSKY_LAB'):
        return Path(given).absolute()
    clone = ['git', 'clone', '--quiet', '--depth', '1', '--branch', LAB_TAG, LAB_URL]
    subprocess.run([*clone, str(folder / 'lab')], check=True)
    return folder / 'lab'


def allow_jail() -> None:
    """Let programs make namespaces, which the jail is made of; Ubuntu 24.04 does not."""
    if RESTRICTED.is_file() and RESTRICTED.read_text().strip() != '0':
        setting = 'kernel.apparmor_restrict_unprivileged_userns=0'
        subprocess.run(['sudo', '-n', 'sysctl', '-q', '-w', setting], check=True)


def main() -> int:
    """Grade it, and return the exit status of the grading."""
    RESULT.unlink(missing_ok=True)  # a student's own
    rubric = Path(__file__).resolve().with_name('rubric.yaml')
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        lab = fetched_lab(folder)
        allow_jail()
        command = [str(lab / 'lab'), 'exec', 'python3', '-m', 'husky_grader.autograder.grade_one']
        command += ['--for', 'classroom50', '--report', str(folder / 'report')]
        command += ['--rubric', str(rubric)] if rubric.is_file() else []
        command += ['--result', str(folder / 'result.json'), str(Path.cwd())]
        # Not here, where Python would take a husky_grader of the student's for the lab's.
        status = subprocess.run(command, cwd=folder).returncode
        if status == 0:
            shutil.copyfile(folder / 'result.json', RESULT)
    return status


if __name__ == '__main__':
    sys.exit(main())
