# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Matchers of lifecycle nodes, under their old name."""

from collections.abc import Callable
from typing import Any
import warnings

from .. import matchers


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return what ``launch_ros.events.matches_node_name`` does, and warn of the old name."""
    warnings.warn(
        "'launch_ros.events.lifecycle.matches_node_name' is deprecated: use "
        "'launch_ros.events.matches_node_name'",
        stacklevel=2,
    )
    return matchers.matches_node_name(node_name)
