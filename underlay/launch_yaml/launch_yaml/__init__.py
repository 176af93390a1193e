# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files in YAML."""

from .entity import Entity
from .parser import Parser

__all__ = ['Entity', 'Parser']
