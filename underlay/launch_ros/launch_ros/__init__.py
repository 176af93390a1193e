# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What launch knows of ROS: nodes, parameters, names and packages; our own for the wheels.

Same names and behaviour as ROS 2 Jazzy's package of this name. What needs ROS messages, as the
events of lifecycle nodes, is imported when it is first named.
"""

import importlib
from typing import Any

from . import actions, descriptions, substitutions, utilities
from .default_launch_description import get_default_launch_description

__all__ = [
    'actions',
    'descriptions',
    'event_handlers',
    'events',
    'get_default_launch_description',
    'substitutions',
    'utilities',
]


def __getattr__(name: str) -> Any:
    if name in ('event_handlers', 'events', 'ros_adapters'):
        return importlib.import_module(f'{__name__}.{name}')
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
