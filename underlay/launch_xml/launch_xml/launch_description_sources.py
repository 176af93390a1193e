# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch descriptions from XML files, as an include wants them."""

from __future__ import annotations

from launch.launch_description_sources import FrontendLaunchDescriptionSource
from launch.some_substitutions_type import SomeSubstitutionsType

from .parser import Parser


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Reads an XML launch file when it is included."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, parser=Parser, method='interpreted XML launch file')
