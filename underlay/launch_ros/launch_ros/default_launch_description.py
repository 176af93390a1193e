# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a launch service once had to include for ROS."""

from __future__ import annotations

from collections.abc import Iterable

from launch import LaunchDescription


def get_default_launch_description(
    *, prefix_output_with_name: bool = False, argv: Iterable[str] | None = None
) -> LaunchDescription:
    """Return an empty launch description: nothing of it is needed any more."""
    del prefix_output_with_name, argv
    return LaunchDescription()
