# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is asked when a status is due."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from diagnostic_updater._diagnostic_status_wrapper import DiagnosticStatusWrapper

Fill: TypeAlias = Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]


class DiagnosticTask:
    """Fills one status; to derive from."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        return self.name

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill the status, and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """A task that calls a function, which returns the status that it was given."""

    def __init__(self, name: str, fn: Fill) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks that fill one status: their summaries merged, their values in a row."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def addTask(self, t: DiagnosticTask) -> None:
        self.tasks.append(t)

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        before, merged = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        before.summary(stat)
        for task in self.tasks:
            stat.summary(before)
            stat = filled(task.name, task.run, stat)
            merged.mergeSummary(stat)
        stat.summary(merged)
        return stat


def filled(name: str, fill: Fill, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
    """
    Return the status that a task has filled.

    :raises TypeError: it has returned none, which in C++ it would not have to.
    """
    result = fill(stat)
    if result is None:
        raise TypeError(
            f"the task '{name}' returned None: it has to end with `return` and the status that it "
            'was given'
        )
    return result
