# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Handlers of events that tests wait for."""

from .stdout_ready_listener import StdoutReadyListener

__all__ = ['StdoutReadyListener']
