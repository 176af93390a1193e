# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Import interfaces by their names: 'std_msgs/msg/String'."""

from __future__ import annotations

from collections.abc import Callable
import importlib
from typing import Any


def get_interface(identifier: str) -> Any:
    """Return the class of a message, service or action named 'package/namespace/Type'.

    :raises ValueError: the name has another form.
    :raises ModuleNotFoundError: the package or its namespace is not installed.
    :raises AttributeError: the package has no such interface.
    """
    parts = identifier.split('/')
    if len(parts) < 2 or not all(part.isidentifier() for part in parts):
        raise ValueError(f"'{identifier}' is no interface: a name has the form 'package/msg/Type'")
    module = importlib.import_module('.'.join(parts[:-1]))
    return getattr(module, parts[-1])


def get_message(identifier: str) -> Any:
    """Return the class of a message; 'std_msgs/String' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, 'msg', 'a message', is_message)


def get_service(identifier: str) -> Any:
    """Return the class of a service; 'std_srvs/Empty' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, 'srv', 'a service', is_service)


def get_action(identifier: str) -> Any:
    """Return the class of an action; 'tf2_msgs/LookupTransform' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, 'action', 'an action', is_action)


def is_message(interface: Any) -> bool:
    return hasattr(interface, 'get_fields_and_field_types')


def is_service(interface: Any) -> bool:
    return hasattr(interface, 'Request') and hasattr(interface, 'Response')


def is_action(interface: Any) -> bool:
    return all(hasattr(interface, part) for part in ('Goal', 'Result', 'Feedback'))


def _of_kind(identifier: str, namespace: str, kind: str, is_kind: Callable[[Any], bool]) -> Any:
    name = identifier
    if name.count('/') == 1:
        name = name.replace('/', f'/{namespace}/')
    interface = get_interface(name)
    if not is_kind(interface):
        raise ValueError(f"Expected '{identifier}' to be {kind}")
    return interface
