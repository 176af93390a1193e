# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from collections.abc import Callable

from husky_driver.prompt import ask_move, Move
import pytest


def person(*answers: str) -> tuple[Callable[[str], str], list[str]]:
    """Return a source of these answers, and the list of the questions."""
    asked, left = list[str](), list(answers)

    def answer(question: str) -> str:
        asked.append(question.strip())
        if not left:
            raise EOFError
        return left.pop(0)

    return answer, asked


def test_the_three_questions_of_the_sheet_make_a_move() -> None:
    answer, asked = person('0.5', '3', '1')
    assert ask_move(answer, lambda _: None) == Move(0.5, 3.0, forward=True)
    assert asked == ['Input your speed:', 'Type your distance:', 'Forward?:']


@pytest.mark.parametrize(
    ('text', 'forward'), [('1', True), ('True', True), ('yes', True), ('0', False), ('n', False)]
)
def test_forward_is_answered_as_people_do(text: str, forward: bool) -> None:
    answer, _ = person('-0.5', '-3', text)
    assert ask_move(answer, lambda _: None) == Move(0.5, 3.0, forward)


def test_a_wrong_answer_is_explained_and_asked_again() -> None:
    answer, asked = person('fast', 'nan', '1.2', '0.8', '1e9', '2', 'maybe', '0')
    said = list[str]()
    assert ask_move(answer, said.append) == Move(0.8, 2.0, forward=False)
    assert asked.count('Input your speed:') == 4
    assert said[1:] == [
        "'fast' is not a number; allowed is 0.05 to 1 m/s",
        'nan is out of range; allowed is 0.05 to 1 m/s',
        '1.2 is out of range; allowed is 0.05 to 1 m/s',
        '1e9 is out of range; allowed is 0.05 to 100 m',
        "'maybe' is not an answer; type 1 for forward or 0 for backward",
    ]


def test_the_end_of_input_ends_the_questions() -> None:
    answer, _ = person('0.5')
    with pytest.raises(EOFError):
        ask_move(answer, lambda _: None)
