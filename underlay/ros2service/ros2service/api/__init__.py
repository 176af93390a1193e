# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What verbs of other packages use of `ros2 service`."""

from __future__ import annotations

from typing import Any

from ros2cli import completion
from rtps_graph.names import is_hidden


def get_service_names_and_types(
    *, node: Any, include_hidden_services: bool = False
) -> list[tuple[str, list[str]]]:
    return [
        (name, types)
        for name, types in node.get_service_names_and_types()
        if include_hidden_services or not is_hidden(name)
    ]


def get_service_names(*, node: Any, include_hidden_services: bool = False) -> list[str]:
    found = get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)
    return [name for name, _ in found]


def get_service_class(
    node: Any,
    service_name: str,
    include_hidden_services: bool,
) -> Any:
    """Return the class of a service that somebody has.

    :raises RuntimeError: there is none of this name, or it has no one type that is installed.
    """
    from rosidl_runtime_py.utilities import get_service

    found = get_service_names_and_types(node=node, include_hidden_services=include_hidden_services)
    types = dict(found).get(service_name)
    if not types:
        raise RuntimeError(f"Cannot find type for '{service_name}'")
    if len(types) > 1:
        raise RuntimeError(f"service '{service_name}' has more than one type: {', '.join(types)}")
    try:
        return get_service(types[0])
    except (AttributeError, ModuleNotFoundError, ValueError):
        raise RuntimeError(f"the type '{types[0]}' is not installed") from None


class ServiceNameCompleter(completion.NameCompleter):
    def __init__(self, *, include_hidden_services_key: str | None = None) -> None:
        super().__init__('service', include_hidden_services_key)


class ServiceTypeCompleter(completion.TypeCompleter):
    def __init__(self, *, service_name_key: str | None = None) -> None:
        super().__init__('service', service_name_key)


class ServicePrototypeCompleter(completion.PrototypeCompleter):
    def __init__(self, *, service_type_key: str | None = None) -> None:
        super().__init__(service_type_key)


def service_type_completer(**_: Any) -> list[str]:
    return completion.known_types('service')
