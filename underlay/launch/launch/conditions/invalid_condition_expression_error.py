# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A condition that is neither true nor false."""

from __future__ import annotations

from collections.abc import Sequence

from ..substitution import Substitution


class InvalidConditionExpressionError(ValueError):
    """Raised when the text of a condition does not say true or false."""

    def __init__(
        self,
        expression: str,
        unexpanded_expression: Sequence[Substitution],
        valid_expressions: Sequence[str],
    ) -> None:
        written = ' + '.join(sub.describe() for sub in unexpanded_expression)
        super().__init__(
            f'invalid condition expression, expected one of [{", ".join(valid_expressions)}] but '
            f"got '{expression}', expanded from {written}"
        )
