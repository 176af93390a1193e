# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs of `ros2 service`; packages add theirs in the entry point group 'ros2service.verb'."""

from ros2cli.verb import VerbExtension

__all__ = ['VerbExtension']
