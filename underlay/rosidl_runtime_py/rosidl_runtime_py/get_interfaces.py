# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which interfaces are installed, told by the ament index."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ament_index_python import get_resource, get_resources, has_resource

_RESOURCE = 'rosidl_interfaces'


def get_interface_packages() -> dict[str, str]:
    """Map every package that has interfaces to its prefix."""
    return dict(get_resources(_RESOURCE))


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Map packages to their interfaces, as in {'std_msgs': ['msg/Bool', ...]}.

    :param package_names: the packages to look at; none means all.
    :raises LookupError: a package is not installed.
    """
    chosen = list(package_names)
    for package in chosen:
        if not has_resource('packages', package):
            raise LookupError(f"Unknown package '{package}'")
    known = get_interface_packages()
    found = {
        package: _interfaces(package) for package in chosen or sorted(known) if package in known
    }
    return {package: names for package, names in found.items() if names}


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _of_kind('msg/', package_names)


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _of_kind('srv/', package_names)


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _of_kind('action/', package_names)


def get_interface_path(interface_name: str) -> str:
    """Return the file that defines an interface, as 'std_msgs/msg/String'.

    :raises ValueError: the name has fewer than two parts, or '..' among them.
    :raises LookupError: the package is not installed, or has no such interface.
    """
    parts = interface_name.split('/')
    if len(parts) < 2 or not all(parts) or '..' in parts:
        raise ValueError(f"Invalid name '{interface_name}': it has the form 'package/msg/Type'")
    if not has_resource('packages', parts[0]):
        raise LookupError(f"Unknown package '{parts[0]}'")
    prefix = get_interface_packages().get(parts[0])
    if prefix is None:
        raise LookupError(f"Package '{parts[0]}' has no interfaces")
    file = Path(prefix, 'share', *parts)
    if file.suffix:
        candidates = [file]
    else:
        kind = parts[1] if len(parts) > 2 else 'msg'
        candidates = [file.with_name(f'{file.name}.{kind}'), file.with_name(f'{file.name}.idl')]
    for candidate in candidates:
        if candidate.is_file():
            return str(candidate)
    raise LookupError(f"Could not find the interface '{candidates[-1]}'")


def _interfaces(package: str) -> list[str]:
    content, _ = get_resource(_RESOURCE, package)
    return sorted({name.rpartition('.')[0] for name in content.split() if '_' not in name})


def _of_kind(prefix: str, package_names: Iterable[str]) -> dict[str, list[str]]:
    found = {
        package: [name for name in names if name.startswith(prefix)]
        for package, names in get_interfaces(package_names).items()
    }
    return {package: names for package, names in found.items() if names}
