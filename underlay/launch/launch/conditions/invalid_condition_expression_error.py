# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A condition that is neither true nor false."""


class InvalidConditionExpressionError(Exception):
    """Raised when the text of a condition does not say true or false."""
