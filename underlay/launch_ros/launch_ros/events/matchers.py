# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Matchers of nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a predicate on the name of a Node with its namespace."""
    full_name = node_name if node_name.startswith('/') else f'/{node_name}'
    return lambda action: bool(action.node_name == full_name)
