# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Event handlers for the events of ROS nodes."""

from .on_state_transition import OnStateTransition

__all__ = ['OnStateTransition']
