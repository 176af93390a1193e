# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What goes wrong with bags; upstream raises RuntimeError, of which this is one."""

from __future__ import annotations


class BagError(RuntimeError):
    """Say in one line what was refused or found, what is allowed and what to do."""
