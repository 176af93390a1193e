# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of the launch file."""

from ..frontend.expose import expose_substitution
from .this_launch_file import ThisLaunchFile


@expose_substitution('dirname')
class ThisLaunchFileDir(ThisLaunchFile):
    """Becomes the folder of the launch file it stands in."""

    _local = 'current_launch_file_directory'
