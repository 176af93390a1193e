# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Test ROS nodes that a launch file starts; our own launch_testing_ros for the wheels.

Same names and behaviour as ROS 2 Jazzy's package of this name. Every run of pytest imports this:
what needs rclpy or launch is imported when it is first named.
"""

import importlib
from typing import Any, TYPE_CHECKING

if TYPE_CHECKING:
    from . import tools
    from .data_republisher import DataRepublisher
    from .message_pump import MessagePump
    from .test_runner import LaunchTestRunner
    from .wait_for_topics import WaitForTopics

__all__ = ['DataRepublisher', 'LaunchTestRunner', 'MessagePump', 'WaitForTopics', 'tools']

_CLASSES = {
    'DataRepublisher': 'data_republisher',
    'LaunchTestRunner': 'test_runner',
    'MessagePump': 'message_pump',
    'WaitForTopics': 'wait_for_topics',
}


def __getattr__(name: str) -> Any:
    if name in _CLASSES:
        return getattr(importlib.import_module(f'{__name__}.{_CLASSES[name]}'), name)
    if name == 'tools':
        return importlib.import_module(f'{__name__}.{name}')
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
