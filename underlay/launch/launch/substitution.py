# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a launch file says now and what becomes text when it runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class Substitution:
    """Base of everything that is turned into text while launching."""

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """Turn the arguments of ``$(name argument ...)`` into keyword arguments.

        :param data: one list of substitutions an argument.
        """
        if data:
            raise TypeError(f'{cls.__name__} takes no arguments, got {len(data)}')
        return cls, {}

    def describe(self) -> str:
        return self.__class__.__name__

    def perform(self, context: LaunchContext) -> str:
        """Return the text, which may depend on the state of the launch."""
        raise NotImplementedError(f'{self.__class__.__name__} does not implement perform()')
