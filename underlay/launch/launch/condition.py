# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether an action is executed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Condition:
    """A predicate over the state of the launch."""

    def __init__(self, *, predicate: Callable[[LaunchContext], Any] | None = None) -> None:
        self._predicate = predicate
        self.__last_evaluation: bool | None = None

    def describe(self) -> str:
        return self.__class__.__name__

    def evaluate(self, context: LaunchContext) -> bool:
        """Return what the predicate says; without one, False."""
        self.__last_evaluation = self._predicate is not None and bool(self._predicate(context))
        return self.__last_evaluation

    @property
    def last_evaluation(self) -> bool | None:
        """The last result, None before the first."""
        return self.__last_evaluation
