# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Forms of a text: what teaching staff ask for, and what students are told.

No regular expression of anybody's is run on what students wrote: a form is taken apart once, each
of its parts takes as much as it can, and nothing is tried twice but the places where the text
after `<text>` may begin. So it takes no longer than the square of a text's length, and longer
texts than MAX_TEXT never fit.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from itertools import pairwise
import re
from typing import Any

MAX_TEXT = 1000  # characters
ANYTHING = '<text>'
PLACEHOLDERS = {
    '<number>': re.compile(r'[-+]?\d+(\.\d+)?([eE][-+]?\d+)?', re.ASCII),
    '<digits>': re.compile(r'\d+', re.ASCII),
    '<word>': re.compile(r'\w+'),
}

TOKEN = '{token}'
"""Stands for a whole number that is another in each grading: nobody can print it unheard."""

_Part = str | re.Pattern[str]  # what stands there, or a placeholder


@dataclass(frozen=True)
class Form:
    """
    A text with placeholders: `<number>`, `<digits>`, `<word>`, and `<text>` for anything.

    >>> Form('hello world <number>').fits('hello world 17.25')
    True
    >>> Form('<text>heard<text>').fits('[INFO]: I heard it')
    True
    >>> Form('group_<digits>').fits('group_a')
    False
    """

    text: str

    def __post_init__(self) -> None:
        """
        Take it apart.

        :raises ValueError: when a placeholder is unknown, or what follows it can never be there.
        """
        for parts in self._runs:
            for part, following in pairwise(parts):
                if isinstance(part, re.Pattern) and _takes(part, following):
                    raise ValueError(
                        f'{self.text}: a placeholder takes all that it can, and nothing is left '
                        'for what follows; put something else between, as a space'
                    )

    def __str__(self) -> str:
        return self.text

    def fits(self, text: str) -> bool:
        """Tell whether a text has this form, from its first character to its last."""
        if len(text) > MAX_TEXT:
            return False
        first, *others = self._runs
        at = _end(first, text, 0)
        if not others or at is None:
            return at == len(text)
        for run in others[:-1]:
            ends = (_end(run, text, start) for start in range(at, len(text) + 1))
            at = next((end for end in ends if end is not None), None)
            if at is None:
                return False
        starts = range(at, len(text) + 1)
        return any(_end(others[-1], text, start) == len(text) for start in starts)

    @cached_property
    def _runs(self) -> list[list[_Part]]:
        """The parts between the places where anything may stand."""
        return [_parts(piece) for piece in self.text.split(ANYTHING)]


def _parts(text: str) -> list[_Part]:
    pieces = (piece for piece in re.split(r'(<[^<>\s]*>)', text) if piece)
    return [_placeholder(piece) if re.fullmatch('<.*>', piece) else piece for piece in pieces]


def _placeholder(name: str) -> re.Pattern[str]:
    if name in PLACEHOLDERS:
        return PLACEHOLDERS[name]
    names = [*PLACEHOLDERS, ANYTHING]
    near = get_close_matches(name, names, n=1)
    hint = f'did you mean {near[0]}? ' if near else ''
    raise ValueError(f'{name} is no placeholder; {hint}allowed: {", ".join(names)}')


def _takes(part: re.Pattern[str], following: _Part) -> bool:
    if isinstance(following, re.Pattern):
        return True
    return part.fullmatch(f'1{following[0]}') is not None


def _end(parts: list[_Part], text: str, at: int) -> int | None:
    """Return where these parts end that begin at a place; None where they are not there."""
    for part in parts:
        if isinstance(part, str):
            if not text.startswith(part, at):
                return None
            at += len(part)
        elif found := part.match(text, at):
            at = found.end()
        else:
            return None
    return at


def with_token(value: Any, token: str) -> Any:
    """Put the number of this grading where the texts of a value say so."""
    if isinstance(value, str):
        return value.replace(TOKEN, token)
    if isinstance(value, Mapping):
        return {name: with_token(each, token) for name, each in value.items()}
    return [with_token(each, token) for each in value] if isinstance(value, list) else value
