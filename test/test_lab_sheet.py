# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Every step of the lab sheet, done by a student who starts with an empty folder."""

from collections.abc import Iterator
from pathlib import Path
import re
from urllib.request import urlopen

from playpen_testing.lab_sheet import Block, matches, read_blocks, write_file
from playpen_testing.processes import Processes
from playpen_testing.terminal import Terminal
from playpen_testing.waiting import wait_until
from playpen_testing.which_ros import SOURCED
import pytest

DOCS = Path(__file__).resolve().parent.parent / 'docs'
SHEET = DOCS / 'lab_sheet.md'
WORKSPACE = 'CSE461_07_03'
STEP_WITHIN_SEC = 60.0


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the student an empty home folder."""
    folder = tmp_path / 'home'
    folder.mkdir()
    monkeypatch.setenv('HOME', str(folder))
    return folder


@pytest.fixture
def terminals(
    home: Path, processes: Processes, monkeypatch: pytest.MonkeyPatch
) -> Iterator['Terminals']:
    monkeypatch.chdir(home)
    desk = Terminals(processes)
    yield desk
    for terminal in desk:
        terminal.close()


class Terminals:
    """The terminals of the student's desk, opened when they are first used."""

    def __init__(self, processes: Processes) -> None:
        self._processes = processes
        self._open: dict[str, Terminal] = {}

    def __getitem__(self, name: str) -> Terminal:
        if name not in self._open:
            self._open[name] = Terminal(self._processes)
        return self._open[name]

    def __iter__(self) -> Iterator[Terminal]:
        return iter(self._open.values())


@pytest.mark.timeout(300)
def test_every_step_of_the_sheet_comes_out_as_it_says(home: Path, terminals: Terminals) -> None:
    blocks = read_blocks(SHEET.read_text())
    if SOURCED:  # rqt_graph is a window there, if it is installed: what it saves is put there
        blocks = [block for block in blocks if 'rqt_graph' not in block.text]
        (home / WORKSPACE).mkdir()
        (home / WORKSPACE / 'rosgraph.png').write_bytes(b'the picture')
    for number, block in enumerate(blocks):
        if block.language == 'bash':
            following = next(
                (b for b in blocks[number + 1 :] if _is_same_terminal(b, block)), None
            )
            terminals[block.terminal].type(block.text)
            if following is None or following.language != 'text':
                _finish(terminals[block.terminal], block)
        elif block.language == 'text':
            _compare(terminals[block.terminal], block, _command(blocks, number))
            _save_picture(terminals[block.terminal], home / WORKSPACE)
        else:
            write_file(home / WORKSPACE, block)
    for terminal in terminals:
        if terminal.busy:
            terminal.interrupt()
    assert (home / f'{WORKSPACE}.tar.gz').stat().st_size > 10_000


def _is_same_terminal(block: Block, other: Block) -> bool:
    return block.language in ('bash', 'text') and block.terminal == other.terminal


def _command(blocks: list[Block], number: int) -> Block:
    """Return the block that was typed before an output block."""
    terminal = blocks[number].terminal
    return next(
        b for b in reversed(blocks[:number]) if b.language == 'bash' and b.terminal == terminal
    )


def _finish(terminal: Terminal, command: Block) -> None:
    """Wait for the end of a command, with the exit status that the sheet expects."""
    terminal.wait_until_done(timeout_sec=STEP_WITHIN_SEC)
    expected = int(command.attributes.get('status', '0'))
    assert terminal.statuses[-1] == expected, f'line {command.line}: it shows\n{terminal.screen}'


def _compare(terminal: Terminal, expected: Block, command: Block) -> None:
    """Wait until the terminal shows what the sheet says, while the command runs or at its end."""
    if not command.goes_on:
        _finish(terminal, command)
        assert matches(expected.text, terminal.screen, goes_on=False), (
            f'line {expected.line}: the sheet says\n{expected.text}\nit shows\n{terminal.screen}'
        )
        return
    wait_until(
        lambda: matches(expected.text, terminal.screen, goes_on=True) or not terminal.busy,
        timeout_sec=STEP_WITHIN_SEC,
        what=lambda: f'line {expected.line}: what the sheet says; it shows\n{terminal.screen}',
    )
    assert terminal.busy, f'line {command.line}: it has ended and shows\n{terminal.screen}'


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
