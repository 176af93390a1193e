# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The texts of interface definitions, for commands: what is missing ends them in one line."""

from __future__ import annotations

from collections.abc import Iterator

from ros2_diagnosis import nearest
from rosidl_runtime_py import definitions
from rosidl_runtime_py.definitions import Line

from ros2cli import interfaces
from ros2cli.errors import CommandError


def lines(interface: str) -> Iterator[Line]:
    """Yield the lines of the definition of 'package/msg/Type'.

    :raises CommandError: there is none.
    """
    try:
        yield from definitions.lines(interface)
    except ValueError as error:
        raise CommandError(str(error)) from None
    except LookupError as error:
        hint = nearest.hint(interface, interfaces.known(), at_most=0)
        raise CommandError(f'{error.args[0]}{hint}') from None
