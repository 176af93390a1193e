# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A share of many jobs for one machine of several."""

from collections.abc import Sequence
from dataclasses import dataclass
import re
from typing import TypeVar

Anything = TypeVar('Anything')


@dataclass(frozen=True)
class Shard:
    """Every so many-th job, from one of the first."""

    number: int = 1  # from 1
    count: int = 1

    def of(self, jobs: Sequence[Anything]) -> list[Anything]:
        """Return this machine's share: what lies together, and may be alike, is spread."""
        return list(jobs[self.number - 1 :: self.count])


def parse_shard(text: str) -> Shard:
    """
    Return the shard I/N.

    :raises ValueError: if the text is none.
    """
    found = re.fullmatch(r'(\d{1,9})/(\d{1,9})', text, re.ASCII)
    shard = Shard(int(found[1]), int(found[2])) if found else Shard(0)
    if not 1 <= shard.number <= shard.count:
        raise ValueError(
            f'--shard {text}: give I/N, the number of the shard from 1 to N and how many there are'
        )
    return shard
