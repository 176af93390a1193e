# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Every step of the sheet on services, messages and frames, done in an empty folder."""

from pathlib import Path

from playpen_testing.desk import do_steps, Terminals
from playpen_testing.lab_sheet import read_blocks
from playpen_testing.which_ros import lacks
import pytest

ROOT = Path(__file__).resolve().parent.parent
SHEET = ROOT / 'docs' / 'services_messages_frames.md'
DISTANCE = Path('msg') / 'Distance.msg'


@pytest.mark.timeout(300)
def test_every_step_comes_out_as_the_sheet_says(home: Path, terminals: Terminals) -> None:
    (home / 'lab').symlink_to(ROOT)
    blocks = read_blocks(SHEET.read_text())
    if lacks('tf2_ros'):  # of which are the programs; the module is of tf2_ros_py
        (echo,) = [number for number, b in enumerate(blocks) if 'ros2 run tf2_ros' in b.text]
        del blocks[echo : echo + 2]
    do_steps(blocks, terminals, home / 'CSE461_07_03')


def test_the_rubric_asks_for_the_message_of_the_sheet() -> None:
    (block,) = (
        b for b in read_blocks(SHEET.read_text()) if 'Distance' in b.attributes.get('file', '')
    )
    asked = (ROOT / 'docs' / 'rubrics' / 'odometer_interfaces' / DISTANCE).read_text()

    def fields(text: str) -> list[list[str]]:
        return [line.partition('#')[0].split() for line in text.splitlines()]

    assert fields(block.text) == fields(asked)
