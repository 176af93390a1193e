# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""One submission: whose it is, and where it lies."""

from dataclasses import dataclass
from pathlib import Path

from husky_grader.submission.kinds import Kind


@dataclass(frozen=True)
class Submission:
    """
    What one student or one group has handed in.

    Where a learning management system (LMS) has exported it, the fields below `kind` are filled as
    far as the export says them.
    """

    id: str  # the name of a folder: unique among those found together, and harmless
    source: Path  # the file or folder that it is, or the export that it lies in
    kind: Kind
    lms: str = ''  # 'moodle', 'canvas' or 'gradescope'
    user: str = ''  # their number in the LMS; of a Gradescope group: all, with commas
    name: str = ''
    emails: tuple[str, ...] = ()
    late: bool = False
    attempt: int = 0  # a number that grows with each hand-in
    notes: tuple[str, ...] = ()  # what a person should know of how it was found, a line each
    files: tuple[tuple[str, str], ...] = ()  # in an export: its files there, and their own paths
    refused: str = ''  # why it cannot be unpacked; one line

    @property
    def place(self) -> str:
        """Where a person finds it."""
        if not self.files:
            return str(self.source)
        return f'{self.source}/{self.files[0][0] if len(self.files) == 1 else self.id}'
