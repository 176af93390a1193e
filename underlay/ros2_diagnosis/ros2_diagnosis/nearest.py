# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a person may have meant by a name that does not exist."""

from __future__ import annotations

from collections.abc import Iterable
import difflib


def names(name: str, known: Iterable[str]) -> list[str]:
    """Return up to three names that are near.

    Near is also what has the same last part: '/robot/cmd_vel' for '/cmd_vel'.
    """
    candidates = sorted(set(known))
    near = difflib.get_close_matches(name, candidates, n=3)
    if not near and '/' in name:
        last = name.rpartition('/')[2]
        near = [each for each in candidates if last and each.rpartition('/')[2] == last][:3]
    return near


def hint(name: str, known: Iterable[str], *, at_most: int = 12) -> str:
    """Return a clause for an error message: near names, or all of them where they are few."""
    candidates = sorted(set(known))
    if near := names(name, candidates):
        return f'; did you mean {" or ".join(repr(n) for n in near)}?'
    if candidates and len(candidates) <= at_most:
        return f'; there is {", ".join(candidates)}'
    return ''
