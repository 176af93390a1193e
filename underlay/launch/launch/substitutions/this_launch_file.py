# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The path of the launch file."""

from __future__ import annotations

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..substitution import Substitution
from .substitution_failure import SubstitutionFailure


@expose_substitution('filename')
class ThisLaunchFile(Substitution):
    """Becomes the path of the launch file it stands in."""

    _local = 'current_launch_file_path'

    def describe(self) -> str:
        return f'{type(self).__name__}()'

    def perform(self, context: LaunchContext) -> str:
        known = context.get_locals_as_dict()
        if self._local not in known:
            raise SubstitutionFailure(
                f'{type(self).__name__} used outside of a launch file (in a script)'
            )
        return str(known[self._local])
