# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is graded at once, wherever: a job that depends on nothing but what its key names."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol


@dataclass(frozen=True)
class Outcome:
    """What a job came to: the content of its result file, or why there is none."""

    content: dict[str, Any] | None
    refused: str = ''
    undone: bool = False  # for what this computer lacked, as room: no fault of who handed in
    remembered: bool = False  # it was done before


class Job(Protocol):
    """
    Grades one submission; plain values, so that a worker elsewhere can have it.

    Two jobs of one key come to the same, on every machine.
    """

    @property
    def name(self) -> str:
        """Return the name of its folder in the report."""

    @property
    def result_file(self) -> str:
        """Return the name, in that folder, of the file with its result as JSON."""

    def key(self) -> str:
        """Return a hash of all that the result depends on."""

    def is_result(self, content: object) -> bool:
        """Tell whether what was read has the shape of a result."""

    def forget(self, folder: Path) -> None:
        """Remove what an earlier grading has left in its folder, and nothing else."""

    def run(self, folder: Path, alive: Callable[[], object]) -> Outcome:
        """
        Grade it; its result and its report go to a folder of its own.

        :param alive: is called now and then; a job that does not hangs.
        :raises OSError: when the report cannot be written.
        """
