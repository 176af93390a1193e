# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb of `ros2 doctor` derives from."""

from ros2cli.verb import VerbExtension

__all__ = ['VerbExtension']
