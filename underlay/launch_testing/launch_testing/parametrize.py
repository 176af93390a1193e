# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run one test description with several arguments."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
import functools
from typing import Any

_Parametrized = Callable[[], Iterator[tuple[Callable[..., Any], dict[str, Any]]]]


def parametrize(
    argnames: str, argvalues: Iterable[Any]
) -> Callable[[Callable[..., Any]], _Parametrized]:
    """Return a decorator that lets the tests of a file run once for each of the values.

    :param argnames: arguments of the test description, separated by commas.
    :param argvalues: for each run a value, or a tuple of one for each name.
    """
    names = [name.strip() for name in argnames.split(',') if name.strip()]
    values = [value if isinstance(value, tuple) else (value,) for value in argvalues]

    def decorate(description: Callable[..., Any]) -> _Parametrized:
        @functools.wraps(description)
        def each() -> Iterator[tuple[Callable[..., Any], dict[str, Any]]]:
            for value in values:
                arguments = dict(zip(names, value, strict=False))
                bound = functools.partial(description, **arguments)
                yield functools.update_wrapper(bound, description), arguments

        each.__parametrized__ = True  # type: ignore[attr-defined]
        return each

    return decorate
