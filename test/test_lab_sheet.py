# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Every step of the lab sheet, done by a student who starts with an empty folder."""

from pathlib import Path
import re
from urllib.request import urlopen

from playpen_testing.desk import do_steps, Terminals
from playpen_testing.lab_sheet import matches, read_blocks
from playpen_testing.processes import Processes
from playpen_testing.terminal import Terminal
from playpen_testing.which_ros import SOURCED
import pytest

DOCS = Path(__file__).resolve().parent.parent / 'docs'
SHEET = DOCS / 'lab_sheet.md'
WORKSPACE = 'CSE461_07_03'


@pytest.mark.timeout(300)
def test_every_step_of_the_sheet_comes_out_as_it_says(home: Path, terminals: Terminals) -> None:
    blocks = read_blocks(SHEET.read_text())
    if SOURCED:  # rqt_graph is a window there, if it is installed: what it saves is put there
        blocks = [block for block in blocks if 'rqt_graph' not in block.text]
        (home / WORKSPACE).mkdir()
        (home / WORKSPACE / 'rosgraph.png').write_bytes(b'the picture')
    do_steps(
        blocks,
        terminals,
        home / WORKSPACE,
        on_seen=lambda terminal: _save_picture(terminal, home / WORKSPACE),
    )
    assert (home / f'{WORKSPACE}.tar.gz').stat().st_size > 10_000


def _save_picture(terminal: Terminal, workspace: Path) -> None:
    """Press the button of rqt_graph's page, where one was opened."""
    if page := re.search(r'graph is at (http://\S+/)', terminal.screen):
        shown = urlopen(page[1] + 'graph.svg', timeout=20).read().decode()
        assert _without_places(shown) == _without_places((DOCS / 'topic_graph.svg').read_text())
        (workspace / 'rosgraph.png').write_bytes(urlopen(page[1] + 'graph.png', timeout=20).read())


def _without_places(svg: str) -> str:
    """Return a picture without the numbers in it, which depend on the fonts of the machine."""
    return re.sub(r'="[^"]*\d[^"]*"', '', svg)


def test_a_terminal_that_sources_a_workspace_knows_the_lab(
    home: Path, processes: Processes
) -> None:
    workspace = DOCS.parent / 'install' / 'setup.bash'
    plain = ['env', '-i', f'HOME={home}', 'PATH=/usr/bin:/bin', 'bash', '--noprofile', '--norc']
    command = f'source {workspace} && ros2 pkg prefix topic_demo && ros2 --help'
    process = processes.start(*plain, '-c', f'{command}')
    assert process.wait() == 0, process.output
    assert str(workspace.parent / 'topic_demo') in process.lines


def test_the_sheet_names_what_replaces_each_command_of_ros_1() -> None:
    table = SHEET.read_text().split('## From ROS 1 to ROS 2')[1]
    replaced = [row.split('|')[1] for row in table.splitlines() if row.startswith('| ')]
    for word in (
        *('catkin_create_pkg', 'catkin_make', 'devel/setup.bash', 'chmod +x', 'rosrun', 'roscore'),
        *('rosnode list', 'rostopic list', 'roslaunch', 'rospy.Publisher', 'rospy.Subscriber'),
        *('rospy.init_node', 'rospy.Rate', 'rospy.loginfo', 'rospy.spin', 'rospy.get_time'),
    ):
        assert any(word in cell for cell in replaced), word


def test_every_picture_of_the_sheet_is_there() -> None:
    pictures = re.findall(r'!\[[^]]+\]\(([^)]+)\)', SHEET.read_text())
    assert pictures
    assert [name for name in pictures if not (DOCS / name).is_file()] == []


def test_an_output_that_differs_from_the_sheet_is_seen() -> None:
    assert matches('a 1.5\n...\nlast\n', 'a 22\nx\ny\nlast\n', goes_on=False)
    assert not matches('a 1.5\nlast\n', 'a 22\nx\nlast\n', goes_on=False)
    assert not matches('a 1.5\n', 'a 22\nmore\n', goes_on=False)
    assert not matches('/publisher\n', '/publisher_x\n', goes_on=True)
