# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from io import StringIO
import math

from husky_driver.ros.progress import Progress
import pytest


def test_a_terminal_gets_one_bar_that_is_drawn_over_itself(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv('COLUMNS', '100')
    terminal, lines = StringIO(), list[str]()
    progress = Progress(terminal, lines.append, bar=True)
    progress.update(10.0, 5.0, 6.5, 'waypoint 3 of 5')
    progress.update(10.0, 2.5, 9.5, 'waypoint 4 of 5')
    progress.close()
    shown = terminal.getvalue()
    assert lines == []
    assert shown.count('\r') == 2
    assert shown.count('\n') == 1
    assert '[###############...............]  50%    5.00 m left     6.5 s  waypoint 3' in shown


def test_a_narrow_terminal_gets_no_line_that_wraps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('COLUMNS', '40')
    terminal = StringIO()
    Progress(terminal, print, bar=True).update(10.0, 5.0, 6.5, 'waypoint 3 of 5')
    assert len(terminal.getvalue().lstrip('\r')) < 40
    assert '5.00 m left' in terminal.getvalue()


def test_without_a_terminal_every_tenth_is_a_line() -> None:
    lines = list[str]()
    progress = Progress(StringIO(), lines.append, bar=False)
    for step in range(101):
        progress.update(20.0, 20.0 - step / 5, step / 4, 'on its way')
    assert len(lines) == 10
    assert lines[0] == '10 %: 18.00 m left, 2.5 s, on its way'
    assert lines[-1] == '100 %: 0.00 m left, 25.0 s, on its way'


def test_another_drive_has_lines_of_its_own() -> None:
    lines = list[str]()
    progress = Progress(StringIO(), lines.append, bar=False)
    for remaining_m in (10.0, 2.0, 10.0, 8.0):  # as after a reset
        progress.update(10.0, remaining_m, 1.0, 'on its way')
    assert [line.split(':')[0] for line in lines] == ['80 %', '0 %', '20 %']


@pytest.mark.parametrize('bar', [True, False])
def test_what_is_no_number_is_not_shown(bar: bool) -> None:
    terminal, lines = StringIO(), list[str]()
    progress = Progress(terminal, lines.append, bar=bar)
    progress.update(math.nan, math.nan, 1.0, '')
    progress.update(20.0, math.inf, 1.0, '')
    assert (terminal.getvalue(), lines) == ('', [])
