# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""In which order a process has written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
from typing import Any

from launch.actions import ExecuteLocal

from ..text_matching import decode_output
from ..util import resolveProcesses

_NEARBY_LINES = 3


class SequentialTextChecker:
    """Searches output from where the search before it has ended."""

    def __init__(self, output: Iterable[str]) -> None:
        self._text = ''.join(output)
        self._position = 0

    def assertInText(self, msg: str) -> None:
        self.assertInStdout(msg)

    def assertInStdout(self, msg: str) -> None:
        """Assert that text comes after all that was asserted before.

        :raises AssertionError: it does not; the next search starts where this one did.
        """
        found = self._text.find(msg, self._position)
        if found < 0:
            raise AssertionError(
                f"'{msg}' not found in sequence after previous match.  "
                f'The output near the last matched line:\n{self.get_nearby_lines()}'
            )
        self._position = found + len(msg)

    def get_nearby_lines(self) -> str:
        """Return the lines about the place where the next search starts."""
        before, after = self._text[: self._position], self._text[self._position :]
        # A search that ended with its line shows the whole next lines.
        this, after = after[:1], after[1:]
        first = '\n'.join(before.split('\n')[-_NEARBY_LINES:])
        last = '\n'.join(after.split('\n')[:_NEARBY_LINES])
        return f'{first}{this}{last}'.rstrip('\n')


@contextlib.contextmanager
def assertSequentialStdout(
    proc_output: Any, process: ExecuteLocal | str, cmd_args: object = None
) -> Iterator[SequentialTextChecker]:
    """Give a checker of what a process has written, from the start on.

    The arguments are those of assertInStdout.
    """
    (action,) = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)
    yield SequentialTextChecker([decode_output(proc_output[action])])
