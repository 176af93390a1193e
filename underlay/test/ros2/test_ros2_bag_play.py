# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag play`: what of a bag is played, and how."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from playpen_testing.bags import opened_writer, string
from playpen_testing.processes import find_line
import pytest
from rosbag2_py import TopicMetadata

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
    bag = write_bag({'/strange': UNKNOWN, '/chatter': 'std_msgs/msg/String'})
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
