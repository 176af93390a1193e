# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Matchers of lifecycle nodes."""

from ..matchers import matches_node_name

__all__ = ['matches_node_name']
