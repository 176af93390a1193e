# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What launch knows of ROS: nodes, parameters, names and packages; our own for the wheels.

Same names and behaviour as ROS 2 Jazzy's package of this name.
"""

from . import actions, descriptions, substitutions, utilities

__all__ = ['actions', 'descriptions', 'substitutions', 'utilities']
