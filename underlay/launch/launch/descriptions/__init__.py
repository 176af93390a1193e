# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Descriptions of what actions execute."""

from .executable import Executable

__all__ = ['Executable']
