# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The workspace that a student has at the end of the lab sheet."""

import os
from pathlib import Path
import subprocess

from husky_course.waypoints import load_course

from playpen_testing.lab_sheet import Block, read_blocks, write_file

ROOT = Path(__file__).resolve().parents[2]
SHEET = ROOT / 'docs' / 'lab_sheet.md'
COURSE = ROOT / 'config' / 'waypoints' / 'central_barrier.yaml'
NAME = 'CSE461_07_03'


def write_solution(folder: Path, course: Path = COURSE) -> Path:
    """
    Make the packages and write the files as the sheet says; return the workspace.

    :param course: the waypoint file that the driver follows.
    """
    workspace = folder / NAME
    (workspace / 'src').mkdir(parents=True)
    for block in read_blocks(SHEET.read_text()):
        if block.language == 'python':
            write_file(workspace, block)
        elif 'ros2 pkg create' in block.text:
            subprocess.run(
                ['bash', '-ec', block.text],
                cwd=workspace / 'src',
                env={**os.environ, 'HOME': str(folder.resolve())},
                check=True,
                capture_output=True,
            )
    _write_places(workspace, course)
    return workspace


def _write_places(workspace: Path, course: Path) -> None:
    """Complete the places to drive to, of which the sheet shows the beginning."""
    stops = load_course(course).stops[1:]
    lines = ''.join(f'    ({stop.x_m}, {stop.y_m}),\n' for stop in stops)
    text = f'WAYPOINTS = [\n{lines}]\n'
    write_file(
        workspace, Block('python', {'edit': 'src/my_driver/my_driver/follow_path.py'}, text, 0)
    )
