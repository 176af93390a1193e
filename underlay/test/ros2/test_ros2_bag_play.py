# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag play`: what of a bag is played, and how."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import time
from typing import Any

from playpen_testing.bags import opened_writer, string
from playpen_testing.processes import find_line
import pytest
from rosbag2_py import TopicMetadata

STRING = 'std_msgs/msg/String'
UNKNOWN = 'not_installed_msgs/msg/Strange'


@pytest.fixture
def write_bag(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes 'number N' to each topic in turn, 10 ms apart."""

    def write(types: dict[str, str], count: int = 6) -> Path:
        writer = opened_writer(tmp_path / 'bag')
        for name, type_name in types.items():
            writer.create_topic(TopicMetadata(0, name, type_name, 'cdr'))
        for number in range(count):
            writer.write(list(types)[number % len(types)], string(number), number * 10_000_000)
        writer.close()
        return tmp_path / 'bag'

    return write


def test_a_topic_of_unknown_type_is_left_out(
    write_bag: Callable[..., Path], processes: Any, ros2: Callable[..., Any]
) -> None:
    bag = write_bag({'/strange': UNKNOWN, '/chatter': STRING})
    listener = processes.node('listener', 'listener')
    played = ros2('bag', 'play', str(bag))
    assert played.status == 0
    assert played.err.count('\n') == 1
    assert '[WARN] [' in played.err
    assert "Topic '/strange' is left out: " in played.err
    assert "package 'not_installed_msgs' not found" in played.err
    for number in (1, 3, 5):
        find_line(listener.stdout, f'^heard number {number}$')


def test_a_bag_of_unknown_types_is_refused(
    write_bag: Callable[..., Path], domain: int, ros2: Callable[..., Any]
) -> None:
    bag = write_bag({'/strange': UNKNOWN, '/stranger': UNKNOWN})
    played = ros2('bag', 'play', str(bag))
    assert (played.status, played.out, played.err.count('\n')) == (1, '', 1)
    assert "'/strange' is left out: " in played.err
    assert "'/stranger' is left out: " in played.err


def test_a_file_sets_the_quality_of_service(
    write_bag: Callable[..., Path], processes: Any, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    bag = write_bag({'/chatter': STRING})
    (tmp_path / 'qos.yaml').write_text(
        'chatter:\n'
        '  history: keep_all\n  depth: 0\n'
        '  reliability: best_effort\n  durability: transient_local\n'
        '  deadline: {sec: 1, nsec: 5}\n  lifespan: {sec: 0, nsec: 0}\n'
        '  liveliness: manual_by_topic\n  liveliness_lease_duration: {sec: 2, nsec: 0}\n'
        '  avoid_ros_namespace_conventions: false\n'
    )
    words = ('--qos-profile-overrides-path', str(tmp_path / 'qos.yaml'), '--delay', '60')
    processes.ros2('bag', 'play', str(bag), *words)
    deadline = time.monotonic() + 20.0
    while 'Node name: rosbag2_player' not in (info := ros2('topic', 'info', '-v', '/chatter').out):
        assert time.monotonic() < deadline, 'no publisher of the player within 20 s'
    for line in (
        'Reliability: BEST_EFFORT',
        'Durability: TRANSIENT_LOCAL',
        'Lifespan: Infinite',
        'Deadline: 1000000005 nanoseconds',
        'Liveliness: MANUAL_BY_TOPIC',
        'Liveliness lease duration: 2000000000 nanoseconds',
    ):
        assert f'{line}\n' in info


def test_a_bad_file_of_qualities_is_refused(
    write_bag: Callable[..., Path], domain: int, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    (tmp_path / 'qos.yaml').write_text('/chatter: {depth: many}')
    bag = write_bag({'/chatter': STRING})
    answer = ros2('bag', 'play', str(bag), '--qos-profile-overrides-path', 'qos.yaml')
    assert (answer.status, answer.err.count('\n')) == (2, 1)
    assert "depth: 'many' must be a whole number" in answer.err
