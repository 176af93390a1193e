# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What tests do with the output of nodes."""

from .output import basic_output_filter

__all__ = ['basic_output_filter']
