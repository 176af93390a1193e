# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node of docs/simulator.md that sees: it turns the robot to the cone."""

from pathlib import Path
import re

from playpen_testing.processes import Processes
from playpen_testing.waiting import wait_until
import pytest

DOCUMENT = Path(__file__).resolve().parent.parent / 'docs' / 'simulator.md'
SIMULATOR = ('ros2', 'run', 'husky_sim', 'husky_sim', '--ros-args', '-p', 'camera_rate_hz:=5.0')
AHEAD = re.compile(r'the cone is [+-]0\.0[0-2] of')


@pytest.mark.timeout(180)
def test_the_cone_comes_ahead(tmp_path: Path, processes: Processes) -> None:
    (node,) = re.findall(r'```python\n(.*?)```', DOCUMENT.read_text(), re.DOTALL)
    (tmp_path / 'cone_seeker.py').write_text(node)
    processes.start(*SIMULATOR)
    seeker = processes.start('python3', 'cone_seeker.py', cwd=tmp_path)
    seeker.wait_for_text('the cone is -0.4', timeout_sec=60.0)  # at the right edge
    wait_until(
        lambda: any(AHEAD.search(line) for line in seeker.lines),
        timeout_sec=90.0,
        what=lambda: f'the cone ahead of the robot; the node told:\n{seeker.output}',
    )
