# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import re
import subprocess
import sys

from topic_demo.node_name import unique_node_name

PROGRAM = 'from topic_demo.node_name import unique_node_name; print(unique_node_name("publisher"))'


def test_a_name_starts_with_its_base_and_is_a_valid_node_name() -> None:
    assert re.fullmatch(r'publisher_\d+_\d+', unique_node_name('publisher'))


def test_two_processes_get_two_names() -> None:
    names = {
        subprocess.run(
            [sys.executable, '-c', PROGRAM], check=True, capture_output=True, text=True
        ).stdout
        for _ in range(2)
    }
    assert len(names) == 2
