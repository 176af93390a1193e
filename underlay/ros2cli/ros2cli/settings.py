# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of ROS 2 in the environment, refused in one line where they are wrong."""

from __future__ import annotations

from rtps_graph import settings
from rtps_graph.settings import Settings

from ros2cli.errors import UsageError


def settings_from_environment() -> Settings:
    """Read ROS_DOMAIN_ID and its companions.

    :raises UsageError: a variable holds what ROS 2 does not know.
    """
    try:
        return settings.settings_from_environment()
    except ValueError as error:
        raise UsageError(str(error)) from None
