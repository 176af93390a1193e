# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Import the Python class of a message that another message contains."""

from __future__ import annotations

import importlib
from typing import Any

from rosidl_parser.definition import NamespacedType


def import_message_from_namespaced_type(message_type: NamespacedType) -> Any:
    """Return the class of a message type.

    :raises ModuleNotFoundError: its package is not installed.
    :raises AttributeError: the package has no such message.
    """
    module = importlib.import_module('.'.join(message_type.namespaces))
    return getattr(module, message_type.name)
