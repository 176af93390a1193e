# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Test what a launch file starts, with unittest; our own launch_testing for the wheels.

Same names and behaviour as ROS 2 Jazzy's package of this name. Every run of pytest imports this:
what needs launch is imported when it is first named.
"""

import importlib
from typing import Any, TYPE_CHECKING

from .decorator import post_shutdown_test
from .parametrize import parametrize
from .ready_aggregator import ReadyAggregator
from .ready_to_test_action_timeout import ready_to_test_action_timeout

if TYPE_CHECKING:
    from . import tools
    from .io_handler import ActiveIoHandler, IoHandler
    from .proc_info_handler import ActiveProcInfoHandler, ProcInfoHandler

__all__ = [
    'ActiveIoHandler',
    'ActiveProcInfoHandler',
    'IoHandler',
    'ProcInfoHandler',
    'ReadyAggregator',
    'parametrize',
    'post_shutdown_test',
    'ready_to_test_action_timeout',
    'tools',
]

_CLASSES = {
    'ActiveIoHandler': 'io_handler',
    'ActiveProcInfoHandler': 'proc_info_handler',
    'IoHandler': 'io_handler',
    'ProcInfoHandler': 'proc_info_handler',
}
_MODULES = (
    *('actions', 'asserts', 'event_handlers', 'io_handler', 'loader', 'markers'),
    *('proc_info_handler', 'test_result', 'test_runner', 'tools', 'util'),
)


def __getattr__(name: str) -> Any:
    if name in _CLASSES:
        return getattr(importlib.import_module(f'{__name__}.{_CLASSES[name]}'), name)
    if name in _MODULES:
        return importlib.import_module(f'{__name__}.{name}')
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
