# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the grader's own node takes for heard, of all that a program prints."""

from pathlib import Path

from husky_grader.lab.observer import observe
from husky_grader.rubric.steps import SubscriberStep
from husky_grader.run.printed import MAX_AROUND, MAX_LINES, printed_lines
import pytest

TOKEN = 12_345_678


def test_a_number_is_not_heard_by_who_does_not_listen(
    domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setattr('husky_grader.lab.observer.random.randint', lambda *_: TOKEN)
    step = SubscriberStep(
        points=10.0,
        package='zoo',
        executable='guesses',
        topic='/topic_test',
        type='std_msgs/msg/String',
        sent={'data': 'hello grader {token}'},
        printed='heard<text>hello grader {token}',
        within_sec=0.3,
    )
    (tmp_path / 'log').write_text(f'heard hello grader {TOKEN}\n')
    found = observe(step, lambda: False, tmp_path / 'log', tmp_path)
    assert found.score == 0.0
    assert found.why == 'it listens to nothing; the lab asks for /topic_test'


def test_a_word_is_found_wherever_it_was_printed(tmp_path: Path) -> None:
    log, other = tmp_path / 'log', 'another line\n' * 10_000
    log.write_text(f'{other}[INFO] heard {TOKEN}\r\n{other}it was {TOKEN}, {TOKEN}')
    assert printed_lines(log, str(TOKEN)) == [f'[INFO] heard {TOKEN}', f'it was {TOKEN}, {TOKEN}']
    assert printed_lines(tmp_path / 'none', str(TOKEN)) == []
    log.write_text('x' * 1_000_000 + str(TOKEN) + 'y' * 1_000_000 + f'\n{TOKEN}' * 1_000)
    first, *others = printed_lines(log, str(TOKEN))
    assert len(first) == 2 * MAX_AROUND
    assert others == [str(TOKEN)] * (MAX_LINES - 1)
