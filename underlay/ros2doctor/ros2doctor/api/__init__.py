# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a check of `ros2 doctor` is; packages register theirs in the group 'ros2doctor.checks'."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from entry_point_index import entry_points, load


@dataclass
class Result:
    """How many errors and warnings a check has found; it prints them itself."""

    error: int = 0
    warning: int = 0

    def add_error(self) -> None:
        self.error += 1

    def add_warning(self) -> None:
        self.warning += 1


class DoctorCheck:
    """Base of a check."""

    # The options of the command line; upstream's checks are not told them.
    args: argparse.Namespace | None = None

    def category(self) -> str:
        raise NotImplementedError()

    def check(self) -> Result:
        raise NotImplementedError()


def checks(args: argparse.Namespace) -> list[DoctorCheck]:
    """Make every registered check, in the order of the names of their entry points."""
    made: list[DoctorCheck] = [
        load(target)() for _, target in sorted(entry_points('ros2doctor.checks').items())
    ]
    for check in made:
        check.args = args
    return made
