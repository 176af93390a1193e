# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of the launch file."""

from __future__ import annotations

from ..frontend.expose import expose_substitution
from ..launch_context import LaunchContext
from ..substitution import Substitution
from .substitution_failure import SubstitutionFailure


@expose_substitution('dirname')
class ThisLaunchFileDir(Substitution):
    """Becomes the folder of the launch file it stands in."""

    def describe(self) -> str:
        return 'ThisLaunchFileDir()'

    def perform(self, context: LaunchContext) -> str:
        known = context.get_locals_as_dict()
        if 'current_launch_file_directory' not in known:
            raise SubstitutionFailure(
                'ThisLaunchFileDir used outside of a launch file (in a script)'
            )
        return str(known['current_launch_file_directory'])
