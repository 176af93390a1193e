# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Whether two values differ."""

from __future__ import annotations

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from .equals_substitution import EqualsSubstitution


@expose_substitution('not-equals')
class NotEqualsSubstitution(EqualsSubstitution):
    """Becomes 'false' where both are the same text, truth value or number, else 'true'."""

    def perform(self, context: LaunchContext) -> str:
        return 'false' if super().perform(context) == 'true' else 'true'
