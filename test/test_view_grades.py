# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of grades, in a real browser."""

from husky_grader.graded import Graded, StepGrade
from husky_grader.outputs.student_page import student_page
from playpen_testing.graded_class import submission
from playwright.sync_api import Browser
import pytest

# Each word of the first column that a browser has parted into two lines.
_BROKEN = r"""() => [...document.querySelectorAll('td:first-child')].flatMap((cell) => {
  const text = cell.firstChild;
  return [...text.data.matchAll(/\S+/g)].filter((word) => {
    const range = document.createRange();
    range.setStart(text, word.index);
    range.setEnd(text, word.index + word[0].length);
    return new Set([...range.getClientRects()].map((box) => box.top)).size > 1;
  }).map((word) => word[0]);
})"""


@pytest.mark.parametrize('width', [1100, 375])
def test_a_long_reason_leaves_room_for_the_name_of_a_step(browser: Browser, width: int) -> None:
    why = 'missed waypoint 4 at (4.1, -3.2): it came no nearer than 0.66 m; ' * 4
    names = ('workspace', 'package topic_demo', 'subscriber', 'drive')
    graded = Graded(submission(1), 40.0, [StepGrade(name, 20.0, 10.0, why) for name in names])
    page = browser.new_page(viewport={'width': width, 'height': 700})
    page.set_content(student_page(graded, []))
    assert page.evaluate(_BROKEN) == []
    page.close()
