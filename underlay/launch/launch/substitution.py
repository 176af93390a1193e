# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a launch file says now and what becomes text when it runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, TYPE_CHECKING

if TYPE_CHECKING:
    from .launch_context import LaunchContext


class MarkupArguments:
    """The keywords that the arguments of ``$(name argument ...)`` are passed by, in their order.

    :param required: how many there are at least; default: all.
    :param of: begins the message of the error for another number; default: the class.
    :param error: its type, which upstream has chosen for each substitution.
    """

    def __init__(
        self,
        *keywords: str,
        required: int | None = None,
        of: str | None = None,
        error: type[Exception] = TypeError,
    ) -> None:
        self._keywords = keywords
        self._required = len(keywords) if required is None else required
        self._of = of
        self._error = error

    def by_keyword(self, cls: type[Substitution], data: Sequence[Any]) -> dict[str, Any]:
        """Return the arguments by keyword."""
        allowed = range(self._required, len(self._keywords) + 1)
        if len(data) not in allowed:
            plural = '' if allowed[-1] == 1 else 's'
            raise self._error(
                f'{self._of or cls.__name__} expects {" or ".join(map(str, allowed))} '
                f'argument{plural}, got {len(data)}'
            )
        return dict(zip(self._keywords, data, strict=False))


class Substitution:
    """Base of everything that is turned into text while launching."""

    _arguments: ClassVar[MarkupArguments | None] = None

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """Turn the arguments of ``$(name argument ...)`` into keyword arguments.

        :param data: one list of substitutions an argument.
        """
        if cls._arguments is not None:
            return cls, cls._arguments.by_keyword(cls, data)
        if data:
            raise TypeError(f'{cls.__name__} takes no arguments, got {len(data)}')
        return cls, {}

    def describe(self) -> str:
        return self.__class__.__name__

    def perform(self, context: LaunchContext) -> str:
        """Return the text, which may depend on the state of the launch."""
        raise NotImplementedError(f'{self.__class__.__name__} does not implement perform()')
