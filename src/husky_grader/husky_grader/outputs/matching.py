# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which line of a table of an LMS is whose."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from husky_grader.graded import Graded


@dataclass(frozen=True)
class Matching:
    """
    What belongs together, and in a sentence each what does not.

    :param graded: what gets into a row, by its number.
    """

    graded: Mapping[int, Graded]
    notes: Sequence[str]


def match(
    everyone: Sequence[Graded], rows_of: Mapping[str, Sequence[int]], names: Mapping[int, str]
) -> Matching:
    """
    Match submissions and rows; of a row that several claim nobody gets it.

    :param rows_of: the numbers of the rows of each submission, by its id.
    :param names: of the students in the rows, by their numbers.
    """
    claims: dict[int, list[Graded]] = {}
    for one in everyone:
        for row in rows_of[one.submission.id]:
            claims.setdefault(row, []).append(one)
    several = {row: claimed for row, claimed in claims.items() if len(claimed) > 1}
    notes = [
        *told('not in it', (o.submission.id for o in everyone if not rows_of[o.submission.id])),
        *told(
            'has handed in nothing, so the line stays as it is',
            (name for row, name in names.items() if row not in claims),
        ),
        *told('claimed by several, so the line stays as it is', (names[row] for row in several)),
    ]
    alone = {row: claimed[0] for row, claimed in claims.items() if row not in several}
    return Matching(alone, notes)


def told_instead(what: str, whom: Iterable[tuple[str, Graded]]) -> list[str]:
    """
    Return a line on those who were refused, and one on those who could not be graded here.

    :param what: what that means for their rows.
    :param whom: their names, and what they got.
    """
    by_word: dict[str, list[str]] = {}
    for name, one in whom:
        by_word.setdefault(one.instead_of_points, []).append(name)
    return [line for word, names in by_word.items() for line in told(f'{word}, {what}', names)]


def told(what: str, whom: Iterable[str]) -> list[str]:
    """Return a line on those whom something concerns; none where it is nobody."""
    names = list(whom)
    return [f'{what} ({len(names)}): {", ".join(names)}'] if names else []
