# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files in markup languages."""

from __future__ import annotations

from ..frontend import InvalidFrontendLaunchFileError, Parser
from ..launch_description import LaunchDescription

__all__ = ['InvalidFrontendLaunchFileError', 'get_launch_description_from_frontend_launch_file']


def get_launch_description_from_frontend_launch_file(
    frontend_launch_file_path: str, *, parser: type[Parser] | None = None
) -> LaunchDescription:
    """Return the description of a file in any language, or in that of the parser."""
    loader = Parser if parser is None else parser
    root_entity, instance = loader.load(frontend_launch_file_path)
    return instance.parse_description(root_entity)
