# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How every command of the driver refuses what it is given: one line, exit code 2."""

from __future__ import annotations

import argparse
import os
import sys
from typing import NoReturn

BAD_INPUT = 2
NOBODY_READS = 141  # as of a program that SIGPIPE ends


class Parser(argparse.ArgumentParser):
    """Refuses with one line instead of the whole usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f'{self.prog}: {message}; see {self.prog} --help\n')


def nobody_reads() -> int:
    """Be quiet when who read the output (`head`, `less`) has seen enough; return the status."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return NOBODY_READS
