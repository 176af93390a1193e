# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the simulator of a graded run tells the grader: the state of the run, in a file of JSON."""

from dataclasses import asdict, dataclass, field
import json
from pathlib import Path

from husky_course.files import replacing


@dataclass(frozen=True)
class Told:
    """What a trial tells: while it runs, then once how it ended."""

    count: int = 0  # of times: who still tells is alive
    time_sec: float = 0.0  # simulated
    waypoints_left: int = 0
    pace: str = ''  # how time passed
    ending: str = ''  # why the run is over; empty while it runs
    failure: str = ''  # why there is no run at all
    notes: list[str] = field(default_factory=list)  # what the graph says about the controller
    unsent: list[str] = field(default_factory=list)  # and of one that has sent no command


def tell(file: Path, told: Told) -> None:
    """Write down what is told; who reads it finds it whole."""
    with replacing(file) as part:
        part.write_text(json.dumps(asdict(told)) + '\n', encoding='utf-8')


def listen(file: Path) -> Told | None:
    """Return what was told last, None before the first time."""
    try:
        return Told(**json.loads(file.read_text(encoding='utf-8')))
    except FileNotFoundError:
        return None
