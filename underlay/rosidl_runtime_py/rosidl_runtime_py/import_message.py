# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Import the Python class of a message that another message contains."""

from __future__ import annotations

import importlib
from typing import Any
import warnings

from rosidl_parser.definition import AbstractNestedType, NamespacedType

_FEEDBACK_MESSAGE = '_FeedbackMessage'


def import_message_from_namespaced_type(message_type: NamespacedType | AbstractNestedType) -> Any:
    """Return the class of a message type.

    :param message_type: in place of it, an array of the type is deprecated.
    :raises ModuleNotFoundError: its package is not installed.
    :raises AttributeError: the package has no such message.
    """
    if isinstance(message_type, AbstractNestedType):
        warnings.warn(
            'an array of a NamespacedType is deprecated here: pass its value_type',
            DeprecationWarning,
            stacklevel=2,
        )
        message_type = message_type.value_type
    module = importlib.import_module('.'.join(message_type.namespaces))
    if message_type.name.endswith(_FEEDBACK_MESSAGE):
        # What a feedback topic carries is only found inside the class of its action.
        action = getattr(module, message_type.name.removesuffix(_FEEDBACK_MESSAGE))
        return action.Impl.FeedbackMessage
    return getattr(module, message_type.name)
