# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The value of a local of the context."""

from __future__ import annotations

from ..launch_context import LaunchContext
from ..substitution import Substitution


class LocalSubstitution(Substitution):
    """Becomes ``str()`` of an expression on the locals, as ``event.reason`` in a handler."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.__description = description

    def describe(self) -> str:
        return f"LocalVar('{self.__description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        return str(eval(f'context.locals.{self.expression}', {}, {'context': context}))
