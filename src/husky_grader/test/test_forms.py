# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Forms of a text, as rubrics have them."""

import time

from husky_grader.rubric.forms import Form
import pytest


@pytest.mark.parametrize(
    ('form', 'text', 'fits'),
    [
        ('hello world <number>', 'hello world 1711179043.967', True),
        ('hello world <number>', 'hello world -2e-05', True),
        ('hello world <number>', 'hello world 3 times', False),
        ('hello world <number>', 'Hello world 3', False),
        ('hello world <number>', 'hello world ', False),
        ('took <number>.', 'took 4.', True),
        ('<text>heard<text>end', 'I heard of the end', True),
        ('<text>heard<text>end', 'I heard of the end of it', False),
        ('<text>a<text>b', 'b a', False),
        ('<text>a<text>b<text>c', 'xa yb zc', True),
        ('<text>a<text>b<text>c', 'b a c', False),
        ('<text>a<text>', 'a', True),
        ('a<text>a', 'a', False),
        ('a<text>', 'a', True),
        ('a<text><text>', 'a', True),
        ('<word> <digits>', 'group 12', True),
        ('', '', True),
        ('a < b', 'a < b', True),
        ('<text>', 'x' * 1000, True),
        ('<text>', 'x' * 1001, False),
    ],
)
def test_a_form_fits_what_it_says(form: str, text: str, *, fits: bool) -> None:
    assert Form(form).fits(text) is fits


@pytest.mark.parametrize('form', ['<digits><number>', '<digits>7', '<word>s', '<text><time>'])
def test_a_form_that_nothing_can_have_is_refused(form: str) -> None:
    with pytest.raises(ValueError, match=r'is no placeholder|nothing is left'):
        Form(form)


def test_no_text_keeps_a_form_busy() -> None:
    form = Form('<text>'.join(f'{k} <digits> <word>' for k in range(9)))
    begun = time.process_time()
    for text in ('0 1 a' * 200, '1' * 1000, '0 ' * 500, '8 1 ' * 250):
        assert not form.fits(text)
    assert time.process_time() - begun < 1.0
