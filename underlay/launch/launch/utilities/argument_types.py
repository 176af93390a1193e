# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of the types of arguments."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Any


def ensure_argument_type(
    argument: object,
    types: type | Iterable[Any],
    argument_name: str,
    caller: str | None = None,
) -> None:
    """Check the type of an argument.

    :raises TypeError: it is of none of the types.
    """
    allowed = tuple(types) if isinstance(types, Iterable) else (types,)
    if isinstance(argument, allowed):
        return
    names = ', '.join(getattr(kind, '__name__', str(kind)) for kind in allowed)
    raise TypeError(
        "{}'{}' is {!r} of type '{}', expected one of: {}".format(
            '' if caller is None else f'{caller}: ',
            argument_name,
            argument,
            type(argument).__name__,
            names,
        )
    )


def create_future(loop: asyncio.AbstractEventLoop | None) -> asyncio.Future[Any]:
    return asyncio.get_running_loop().create_future() if loop is None else loop.create_future()
