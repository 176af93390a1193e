# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Import interfaces by their names: 'std_msgs/msg/String'."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rosidl_parser.definition import NamespacedType

from rosidl_runtime_py.import_message import import_message_from_namespaced_type


def get_interface(identifier: str) -> Any:
    """Return the class of a message, service or action named 'package/namespace/Type'.

    :raises ValueError: the name has another form.
    :raises ModuleNotFoundError: the package or its namespace is not installed.
    :raises AttributeError: the package has no such interface.
    """
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return the class of a message; 'std_msgs/String' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, get_message_namespaced_type, is_message, 'a message')


def get_service(identifier: str) -> Any:
    """Return the class of a service; 'std_srvs/Empty' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, get_service_namespaced_type, is_service, 'a service')


def get_action(identifier: str) -> Any:
    """Return the class of an action; 'tf2_msgs/LookupTransform' is enough.

    :raises ValueError: the name belongs to another kind of interface, or is none.
    """
    return _of_kind(identifier, get_action_namespaced_type, is_action, 'an action')


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type that a name says, which need not exist.

    :raises ValueError: the name has not the form 'package/namespace/Type'.
    """
    *namespaces, name = identifier.split('/')
    if not namespaces or not all(part.isidentifier() for part in (*namespaces, name)):
        raise ValueError(f"'{identifier}' is no interface: a name has the form 'package/msg/Type'")
    return NamespacedType(namespaces, name)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    return _in_namespace(identifier, 'msg')


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    return _in_namespace(identifier, 'srv')


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    return _in_namespace(identifier, 'action')


def is_message(interface: Any) -> bool:
    return hasattr(interface, 'SLOT_TYPES')


def is_service(interface: Any) -> bool:
    return hasattr(interface, 'Request') and hasattr(interface, 'Response')


def is_action(interface: Any) -> bool:
    return all(hasattr(interface, part) for part in ('Goal', 'Result', 'Feedback'))


def _in_namespace(identifier: str, namespace: str) -> NamespacedType:
    """Return the type of a name, in the namespace where the name says none."""
    if identifier.count('/') == 1:
        identifier = identifier.replace('/', f'/{namespace}/')
    return get_namespaced_type(identifier)


def _of_kind(
    identifier: str,
    to_type: Callable[[str], NamespacedType],
    is_kind: Callable[[Any], bool],
    kind: str,
) -> Any:
    interface = import_message_from_namespaced_type(to_type(identifier))
    if not is_kind(interface):
        raise ValueError(f"Expected the full name of {kind}, got '{identifier}'")
    return interface
