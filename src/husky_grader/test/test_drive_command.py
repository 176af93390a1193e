# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`./lab drive` without a simulator: what it leaves where its report is interrupted."""

from pathlib import Path
import subprocess
import sys

from husky_grader.grade import INTERRUPTED

# Drives nothing, and is interrupted while it judges that.
PROGRAM = """
from pathlib import Path
import signal
import sys
import time

from husky_grader import drive_command, programs

def judge(_):
    signal.raise_signal(signal.SIGINT)
    time.sleep(20.0)

drive_command.run_to_end = lambda *_: Path('report/run.record').touch()
drive_command.grade.main = judge
sys.argv[1:] = ['course.yaml', '--no-view']
sys.exit(programs.drive())
"""


def test_an_interrupt_amid_the_report_leaves_no_copy_of_the_course(tmp_path: Path) -> None:
    (tmp_path / 'course.yaml').write_text('waypoints: [[0, 0], [1, 0]]\n')
    ended = subprocess.run(
        [sys.executable, '-c', PROGRAM],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=40.0,
        check=False,
    )
    assert ended.returncode == INTERRUPTED, ended.stderr
    assert ended.stderr.endswith('\ninterrupted\n')
    left = [path.name for path in (tmp_path / 'report').iterdir() if path.name[0] == '.']
    assert left == []
