# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the classes of messages, services and actions, or say why not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros2_diagnosis import nearest, packages
from rosidl_runtime_py import get_interfaces
from rosidl_runtime_py.utilities import get_action, get_message, get_service

from ros2cli.errors import CommandError


def message(name: str) -> Any:
    return _load(name, 'message', 'msg', get_message)


def service(name: str) -> Any:
    return _load(name, 'service', 'srv', get_service)


def action(name: str) -> Any:
    return _load(name, 'action', 'action', get_action)


def populate(msg: Any, values: dict[str, Any], **options: bool) -> list[Callable[..., None]]:
    """Fill a message from YAML.

    :raises CommandError: a value does not fit.
    """
    from rosidl_runtime_py import set_message_fields

    try:
        return set_message_fields(msg, values, **options)
    except (AttributeError, TypeError, ValueError, RecursionError) as error:
        raise CommandError(f'Failed to populate field: {error}') from None


def _load(name: str, what: str, namespace: str, get: Callable[[str], Any]) -> Any:
    try:
        return get(name)
    except ValueError as error:
        raise CommandError(
            f'The passed {what} type is invalid: {error}' + _example(namespace)
        ) from None
    except ModuleNotFoundError:
        package = name.partition('/')[0]
        if package not in packages.installed():
            raise CommandError(
                f"The passed {what} type is invalid: package '{package}' not found: "
                f'{packages.why_missing(package)}'
            ) from None
    except (AttributeError, ImportError):
        pass
    known = get_interfaces().get(name.partition('/')[0], [])
    names = [k.rpartition('/')[2] for k in known if k.startswith(namespace)]
    raise CommandError(
        f"The passed {what} type is invalid: package '{name.partition('/')[0]}' has no "
        f"{what} '{name.rpartition('/')[2]}'{nearest.hint(name.rpartition('/')[2], names)}"
    ) from None


def _example(namespace: str) -> str:
    examples = {'msg': 'std_msgs/msg/String', 'srv': 'std_srvs/srv/Empty'}
    return f', as {examples[namespace]}' if namespace in examples else ''
