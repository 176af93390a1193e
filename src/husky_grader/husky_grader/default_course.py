# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the courses are that come with the lab."""

from __future__ import annotations

from pathlib import Path


def config_folder() -> Path:
    """Return the folder of the configuration: in the source, or as installed."""
    in_source = Path(__file__).resolve().parents[3] / 'config'
    if in_source.is_dir():
        return in_source
    from ament_index_python.packages import get_package_share_directory

    return Path(get_package_share_directory('husky_driver')) / 'config'


def default_course() -> Path:
    """Return the course that is driven when none is named."""
    return config_folder() / 'waypoints' / 'central_barrier.yaml'
