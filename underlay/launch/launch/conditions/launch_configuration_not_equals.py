# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Do it if a launch configuration has another value."""

from __future__ import annotations

from ..launch_context import LaunchContext
from .launch_configuration_equals import LaunchConfigurationEquals


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds where the configuration is not the text, or with None where it is set."""

    def _predicate_func(self, context: LaunchContext) -> bool:
        return not super()._predicate_func(context)
