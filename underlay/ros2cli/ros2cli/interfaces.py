# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the classes of messages, services and actions, and fill them, or say why not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import os
from typing import Any

from rosidl_runtime_py import get_interfaces, set_message_fields
from rosidl_runtime_py.utilities import get_action, get_message, get_service
import yaml

from ros2cli.errors import CommandError

_CHECK_FIELDS = 'ROS_PYTHON_CHECK_FIELDS'
_EXAMPLES = {'message': ', as std_msgs/msg/String', 'service': ', as std_srvs/srv/Empty'}


def message(name: str) -> Any:
    return _load(name, 'message', 'msg', get_message)


def service(name: str) -> Any:
    return _load(name, 'service', 'srv', get_service)


def action(name: str) -> Any:
    return _load(name, 'action', 'action', get_action)


def known(kind: str = '') -> list[str]:
    """List all interfaces; of one kind ('msg', 'srv' or 'action') where it is given."""
    return [
        f'{package}/{name}'
        for package, names in get_interfaces().items()
        for name in names
        if name.startswith(kind)
    ]


def check_full_name(name: str) -> None:
    parts = name.split('/')
    if len(parts) == 3:
        return
    # As in ROS 1, where there was no kind between, or without the package.
    meant = [
        repr(each) for each in known() if parts in (each.split('/')[::2], each.split('/')[2:])
    ]
    near = f'; did you mean {" or ".join(meant[:3])}?' if meant else ''
    raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'{near}")


def filled_in(interface: Any) -> Any:
    """Return the message that a person fills in: a request of a service, a goal of an action."""
    for part in ('Request', 'Goal'):
        interface = getattr(interface, part, interface)
    return interface


def yaml_mapping(text: str) -> dict[str, Any]:
    """Read the values of a message.

    :raises CommandError: the text is no YAML, or no dictionary.
    """
    try:
        values = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        reason = ' '.join(str(error).split())
        raise CommandError(f'{text!r} is no YAML: {reason}') from None
    if not isinstance(values, dict):
        # Nothing is what an unset variable of a shell or an empty pipe gives: no message of zeros.
        is_what = 'empty' if values is None else f'a {type(values).__name__}'
        raise CommandError(
            'The passed value needs to be a dictionary in YAML format: '
            f'"{{field: value}}"; {text!r} is {is_what}'
        )
    return values


def populate(
    msg: Any, values: dict[str, Any], *, told: str = 'field', **options: bool
) -> list[Callable[..., None]]:
    """Fill a message from YAML.

    :param told: what an error says that was to be filled.
    :raises CommandError: a value does not fit.
    """
    try:
        return set_message_fields(msg, values, **options)
    except (AttributeError, TypeError, ValueError, RecursionError) as error:
        raise CommandError(f'Failed to populate {told}: {error}') from None


@contextmanager
def unchecked() -> Iterator[None]:
    """Import messages that do not check their fields.

    The check refuses the largest float32, which may well be received. What is sent is checked by
    `populate`.
    """
    before = os.environ.get(_CHECK_FIELDS)
    os.environ[_CHECK_FIELDS] = '0'
    try:
        yield
    finally:  # what a verb starts, a node as any, has its own check
        if before is None:
            del os.environ[_CHECK_FIELDS]
        else:
            os.environ[_CHECK_FIELDS] = before


def _load(name: str, what: str, namespace: str, get: Callable[[str], Any]) -> Any:
    package, last = name.partition('/')[0], name.rpartition('/')[2]
    try:
        with unchecked():
            return get(name)
    except ValueError as error:
        example = _EXAMPLES.get(what, '')
        raise CommandError(f'The passed {what} type is invalid: {error}{example}') from None
    except ModuleNotFoundError:
        from ros2_diagnosis import packages

        if package not in packages.installed():
            raise CommandError(
                f"The passed {what} type is invalid: package '{package}' not found: "
                f'{packages.why_missing(package)}'
            ) from None
    except (AttributeError, ImportError):
        pass
    full = f'{package}/{namespace}/{last}'
    installed = get_interfaces().get(package, [])
    names = [each.rpartition('/')[2] for each in installed if each.startswith(namespace)]
    if last in names and name != full:
        reason = f"'{name}' is no {what}; did you mean '{full}'?"
    else:
        from ros2_diagnosis import nearest

        reason = f"package '{package}' has no {what} '{last}'{nearest.hint(last, names)}"
    raise CommandError(f'The passed {what} type is invalid: {reason}') from None
