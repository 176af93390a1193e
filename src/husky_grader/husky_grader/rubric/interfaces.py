# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages and services by the names of their types: is there such a type, has it such fields."""

from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import Any

from rosidl_runtime_py import (
    get_message_interfaces,
    get_service_interfaces,
    set_message_fields,
)
from rosidl_runtime_py.utilities import get_message, get_service

_Interfaces = Callable[[], Mapping[str, list[str]]]


def message_type(name: str) -> str:
    """
    Return the name of a type of messages.

    :raises ValueError: when no installed package has it.
    """
    return _known(name, 'messages', get_message, get_message_interfaces, 'std_msgs/msg/String')


def service_type(name: str) -> str:
    """
    Return the name of a type of services.

    :raises ValueError: when no installed package has it.
    """
    return _known(name, 'services', get_service, get_service_interfaces, 'std_srvs/srv/Trigger')


def _known(
    name: str,
    what: str,
    find: Callable[[str], object],
    interfaces: _Interfaces,
    example: str,
) -> str:
    try:
        if name.count('/') == 2 and find(name):
            return name
    except (ValueError, ImportError, AttributeError):
        pass
    names = [f'{package}/{each}' for package, kinds in interfaces().items() for each in kinds]
    near = get_close_matches(name, names, n=1)
    hint = f'did you mean {near[0]}?' if near else f'write it as {example}, or install its package'
    raise ValueError(f'{name} is no type of {what} that is installed here; {hint}')


def type_of_field(message: Any, path: str) -> str:
    """
    Return the type of a field, as `header.frame_id`, in the words of its class: `double[9]`.

    :raises ValueError: when there is none, or it is a message itself; it says which there are.
    """
    kind = ''
    for name in path.split('.'):
        kinds: Mapping[str, str] = getattr(message, 'get_fields_and_field_types', dict)()
        if name not in kinds:
            names = list(kinds)
            near = get_close_matches(name, names, n=1)
            hint = f'did you mean {near[0]}? ' if near else ''
            there = f'allowed: {", ".join(names)}' if names else 'nothing is below it'
            raise ValueError(f'{name} of {path} is no field; {hint}{there}')
        kind = kinds[name]
        message = getattr(message, name)
    if hasattr(message, 'get_fields_and_field_types'):
        fields = ', '.join(message.get_fields_and_field_types())
        raise ValueError(f'{path} is a message; name one of its fields: {fields}')
    return kind


def filled(message: Any, values: Mapping[str, Any]) -> Any:
    """
    Return the message with its fields set.

    :raises ValueError: when it lacks such a field, or a value does not fit.
    """
    _check_truths(message, values)
    try:
        set_message_fields(message, values)
    except (AttributeError, TypeError, ValueError, AssertionError) as error:
        raise ValueError(' '.join(str(error).split())) from None
    return message


def _check_truths(message: Any, values: Mapping[str, Any]) -> None:
    """Refuse what is no truth value in the place of one: a sourced ROS takes any text for true."""
    for name, value in values.items():
        field = getattr(message, name, None)
        if isinstance(field, bool) and not isinstance(value, bool):
            raise ValueError(f'{name}: {value!r} is refused: true and false are allowed')
        if isinstance(value, Mapping):
            _check_truths(field, value)
