# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a step came to."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Finding:
    """
    What was found out about a step; plain values, so that another process may find it out.

    :param why: what is right about it, or why it gets nothing.
    :param score: percent of its points, before its defects.
    :param defects: why each costs something, by its name in the costs of the step.
    :param printed: what the program or the build has printed, as much as a report holds.
    """

    why: str
    score: float = 100.0
    defects: Mapping[str, str] = field(default_factory=dict)
    printed: str = ''


def nothing(why: str) -> Finding:
    """Return the finding on a step that gets no points at all."""
    return Finding(why, score=0.0)
