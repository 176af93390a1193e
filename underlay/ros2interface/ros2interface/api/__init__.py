# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The interfaces that are installed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ros2cli import interfaces
from rosidl_runtime_py import get_interface_packages, message_to_yaml
from rosidl_runtime_py.utilities import get_interface


def package_name_completer(**_: Any) -> Iterable[str]:
    return get_interface_packages()


def type_completer(**_: Any) -> list[str]:
    return sorted(interfaces.known())


def interface_to_yaml(identifier: str) -> str:
    """Return the default values of a message, a request of a service or a goal of an action.

    :raises ValueError, ImportError, AttributeError: there is no such interface.
    """
    return str(message_to_yaml(interfaces.filled_in(get_interface(identifier))()))
