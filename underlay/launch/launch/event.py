# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Base of the events of a launch."""


class Event:
    """Something that happened, or is asked to happen."""

    name = 'launch.Event'
