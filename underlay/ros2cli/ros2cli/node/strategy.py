# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The node that upstream's verbs ask for; without a daemon it is always one of their own."""

from ros2cli.discovery import add_arguments
from ros2cli.node.direct import DirectNode

__all__ = ['NodeStrategy', 'add_arguments']


class NodeStrategy(DirectNode):
    pass
