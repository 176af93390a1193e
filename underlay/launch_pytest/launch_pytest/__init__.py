# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Test what a launch file starts, with pytest; our own launch_pytest for the wheels.

Same names and behaviour as ROS 2 Jazzy's package of this name. Every run of pytest imports this:
what needs launch is imported when it is first named.
"""

import importlib
from typing import Any, TYPE_CHECKING

from .fixture import fixture

if TYPE_CHECKING:
    from . import actions, tools

__all__ = ['actions', 'fixture', 'tools']


def __getattr__(name: str) -> Any:
    if name in ('actions', 'tools'):
        return importlib.import_module(f'{__name__}.{name}')
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
