# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag burst`, and the services that take a player to another place of the bag."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from builtin_interfaces.msg import Time
from playpen_testing.bags import opened_writer, string
from playpen_testing.keyboard import RIGHT
from playpen_testing.services import ask
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rosbag2_interfaces.msg import ReadSplitEvent
from rosbag2_interfaces.srv import Burst, IsPaused, Play, PlayNext, Resume, Seek, Stop
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

START_SEC = 100


class Student:
    """Hears what is played, and asks the player."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self.heard: list[int] = []
        self.times: list[Clock] = []
        self.splits: list[ReadSplitEvent] = []
        for topic in ('/chatter', '/other'):
            node.create_subscription(String, topic, self._on_number, 100)
        node.create_subscription(Clock, '/clock', self.times.append, 10)
        node.create_subscription(ReadSplitEvent, '/events/read_split', self.splits.append, 10)

    def _on_number(self, msg: String) -> None:
        self.heard.append(int(msg.data.split()[1]))

    def call(self, kind: Any, name: str, **fields: object) -> Any:
        return ask(self._node, kind, f'/rosbag2_player/{name}', **fields)

    def seek(self, tenths: int) -> None:
        """Go to a time, in tenths of a second since the start of the bag."""
        sec, tenths = divmod(tenths, 10)
        time = Time(sec=START_SEC + sec, nanosec=tenths * 100_000_000)
        assert self.call(Seek, 'seek', time=time).success

    def wait_for(self, *numbers: int) -> None:
        """Wait until these have been heard since the last time, and no others."""
        wait_until(
            lambda: len(self.heard) >= len(numbers),
            timeout_sec=10.0,
            what=lambda: f'more than {self.heard}',
        )
        assert self.heard == list(numbers)
        self.heard.clear()


@pytest.fixture
def student(domain: int) -> Iterator[Student]:
    with SpunNodes(domain) as nodes:
        yield Student(nodes.start(Node, 'student'))


@pytest.fixture(params=['mcap', 'sqlite3'])
def bag(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """Return a bag of two files with 'number 0' to 'number 19', 0.1 s apart."""
    writer = opened_writer(tmp_path / 'bag', '/chatter', storage_id=request.param)
    for number in range(20):
        if number == 10:
            writer.split_bagfile()
        writer.write('/chatter', string(number), START_SEC * 10**9 + number * 10**8)
    writer.close()
    return tmp_path / 'bag'


def test_a_player_goes_to_another_place(bag: Path, student: Student, processes: Any) -> None:
    words = ('--clock', '20', '--start-offset', '0.3')
    player = processes.ros2('bag', 'play', str(bag), '-p', *words, ready='Playing 1 of 1')
    assert student.call(Burst, 'burst', num_messages=3).actually_burst == 3
    student.wait_for(3, 4, 5)
    student.seek(14)
    assert student.call(PlayNext, 'play_next').success
    student.wait_for(14)
    student.seek(6)
    sought = Clock()
    sought.clock.sec, sought.clock.nanosec = START_SEC, 600_000_000
    wait_until(lambda: sought in student.times, timeout_sec=10.0, what='the time that was sought')
    assert student.call(Burst, 'burst', num_messages=1).actually_burst == 1
    student.wait_for(6)
    student.seek(9)
    assert student.call(Burst, 'burst', num_messages=2).actually_burst == 2
    student.wait_for(9, 10)
    wait_until(lambda: student.splits, timeout_sec=10.0, what='the event of a new file')
    student.seek(0)  # before the start, which --start-offset says
    assert student.call(Burst, 'burst', num_messages=2).actually_burst == 2
    student.wait_for(3, 4)
    student.seek(50)  # after the end
    assert student.call(Burst, 'burst').actually_burst == 0
    assert student.call(IsPaused, 'is_paused').paused
    student.seek(17)
    assert student.call(Burst, 'burst').actually_burst == 3
    student.wait_for(17, 18, 19)
    student.seek(18)
    student.call(Resume, 'resume')
    student.wait_for(18, 19)
    assert player.wait(timeout=10.0) == 0
    (split,) = student.splits  # none of a place that was sought
    files = sorted(str(file) for file in bag.glob('bag_*'))
    assert [split.closed_file, split.opened_file] == files
    assert split.node_name == '/rosbag2_player'


def test_a_place_that_is_sought_during_the_delay_is_where_it_begins(
    bag: Path, student: Student, processes: Any
) -> None:
    player = processes.ros2('bag', 'play', str(bag), '-d', '5', ready='Playing 1 of 1')
    student.seek(18)
    student.wait_for(18, 19)
    assert player.wait(timeout=10.0) == 0


@pytest.mark.parametrize('words', [('--loop', '-r', '0.01'), ('-p',), ('-d', '600', '-l')])
def test_a_player_that_is_stopped_ends(
    bag: Path, student: Student, processes: Any, words: tuple[str, ...]
) -> None:
    player = processes.ros2('bag', 'play', str(bag), *words, ready='Playing 1 of 1')
    assert not student.call(Play, 'play').success  # it is being played
    if '-p' not in words:
        assert student.call(Burst, 'burst').actually_burst == 0  # it is not paused
    student.call(Stop, 'stop')
    assert player.wait(timeout=10.0) == 0
    assert student.heard in ([], [0])


def test_a_burst_plays_at_once_and_pauses(
    bag: Path, student: Student, in_terminal: Callable[..., Any], tmp_path: Path
) -> None:
    words = ('-n', '3', '--start-offset', '0.45', '-m', '/chatter:=/other', '--topics', 'chatter')
    (tmp_path / 'config.yaml').write_text('')
    config = ('--storage-config-file', str(tmp_path / 'config.yaml'))
    terminal = in_terminal('ros2', 'bag', 'burst', str(bag), *words, *config)
    terminal.wait_for_text('Played 3 messages at once')
    student.wait_for(5, 6, 7)
    terminal.press(RIGHT)
    student.wait_for(8)
    student.seek(18)
    terminal.press(' ')
    assert terminal.process.wait(timeout=10.0) == 0
    student.wait_for(18, 19)


def test_a_burst_of_no_number_is_of_all(bag: Path, student: Student, processes: Any) -> None:
    processes.ros2('bag', 'burst', str(bag), ready='Played 20 messages at once')
    student.wait_for(*range(20))
    assert student.call(IsPaused, 'is_paused').paused


def test_a_bad_burst_is_refused(bag: Path, domain: int, ros2_here: Callable[..., Any]) -> None:
    for words, message in {
        ('-n', '-3'): "'-3' is refused: it must be a whole number, 0 or more",
        ('--storage-config-file', 'none'): "cannot open 'none': No such file or directory",
    }.items():
        answer = ros2_here('bag', 'burst', str(bag), *words)
        assert answer.status == 2
        assert message in answer.err
