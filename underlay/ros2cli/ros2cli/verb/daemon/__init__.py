# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 daemon` can do."""

from ros2cli.verb import VerbExtension

__all__ = ['VerbExtension']
