# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 bag record`: which topics and services are recorded, and into what."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from pathlib import Path
import signal
import sqlite3
import sys
import time
from typing import Any

from playpen_testing.bags import opened_reader
import pytest

SUMS = '/add_two_ints/_service_event'


class Recording:
    """`ros2 bag record` into sqlite3, where all that is recorded can be counted at once."""

    def __init__(self, processes: Any, folder: Path, *words: str) -> None:
        self.bag = folder / 'bag'
        self._process = processes.ros2(
            *('bag', 'record', '-s', 'sqlite3', '-o', str(self.bag), *words), ready='Recording...'
        )

    def wait_for(self, *topics: str, count: int = 1) -> None:
        deadline = time.monotonic() + 20.0
        while missing := [each for each in topics if self._count(each) < count]:
            assert time.monotonic() < deadline, f'not recorded within 20 s: {missing}'
            time.sleep(0.05)

    def end(self) -> list[str]:
        """Interrupt it; return the names of what was recorded."""
        self._process.send_signal(signal.SIGINT)
        rest, _ = self._process.communicate(timeout=10)
        assert 'Recording stopped: ' in rest
        return [each.name for each in opened_reader(self.bag).get_all_topics_and_types()]

    def _count(self, topic: str) -> int:
        query = (
            'SELECT COUNT(*) FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name=?)'
        )
        number = 0
        for file in self.bag.glob('*.db3'):
            with closing(sqlite3.connect(f'{file.as_uri()}?mode=ro', uri=True)) as opened:
                number += int(opened.execute(query, (topic,)).fetchone()[0])
        return number


@pytest.fixture
def record(processes: Any, tmp_path: Path) -> Callable[..., Recording]:
    """Return a function that starts a recording, which ends with the test."""

    def start(*words: str) -> Recording:
        return Recording(processes, tmp_path, *words)

    return start


@pytest.fixture
def sums(processes: Any) -> None:
    """Let a service add, and tell of it."""
    processes.start(
        *(sys.executable, '-m', 'demo_nodes_py.services.introspection', '--ros-args'),
        *('-p', 'client_configure_introspection:=contents'),
        *('-p', 'service_configure_introspection:=contents'),
        ready='Result of add_two_ints: 5',
    )


def test_events_of_a_service_are_recorded(sums: None, record: Callable[..., Recording]) -> None:
    recording = record(SUMS)
    recording.wait_for(SUMS, count=4)
    assert recording.end() == [SUMS]
    (definition,) = opened_reader(recording.bag).get_all_message_definitions()
    assert 'int64 sum' in definition.encoded_message_definition
