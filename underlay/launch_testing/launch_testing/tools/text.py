# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Text matching under upstream's name of it."""

from ..text_matching import build_line_match, build_text_match, normalize_lineseps

__all__ = ['build_line_match', 'build_text_match', 'normalize_lineseps']
