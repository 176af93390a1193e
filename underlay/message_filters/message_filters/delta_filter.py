# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that differ from the one before in what matters."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from message_filters.simple_filter import connect, SimpleFilter

FieldGetter = Callable[[Any], Any]


class ComparisonHandler(ABC):  # noqa: B024 - as upstream, whoever forgets a method is told so
    """Decides which messages are let out."""

    def message_fits(self, message: Any) -> bool:
        raise NotImplementedError(f'{type(self).__name__} needs a method message_fits(message)')

    def do_fields_fit(self, field_a: Any, field_b: Any) -> bool:
        raise NotImplementedError(
            f'{type(self).__name__} needs a method do_fields_fit(field_a, field_b), which tells '
            'whether a message is let out'
        )


class CachedComparisonHandler(ComparisonHandler):
    """Compares a message with the last that was let out, field by field.

    A class derived from it has `_field_getters` and `do_fields_fit`, to which the values are
    handed, of the older message first; the message is let out where that is true of any field.
    """

    _field_getters: Sequence[FieldGetter]

    def __init__(self) -> None:
        super().__init__()
        self._message_cache: Any = None

    def message_fits(self, message: Any) -> bool:
        """Tell whether to let out a message; the first always."""
        before = self._message_cache
        if before is not None and not any(
            self.do_fields_fit(get(before), get(message)) for get in self._field_getters
        ):
            return False
        self._message_cache = message
        return True


class DeltaCompare(CachedComparisonHandler):
    """Tells whether any of some fields has changed."""

    _basic_types = (bool, int, float, str)

    def __init__(self, field_getters: Sequence[FieldGetter]) -> None:
        """Take functions that return a field of a message, of a basic type."""
        super().__init__()
        self._field_getters = field_getters

    def do_fields_fit(self, val_a: Any, val_b: Any) -> bool:
        """Tell whether two values differ.

        :raises TypeError: one is no bool, int, float or str.
        """
        for value in (val_a, val_b):
            if not isinstance(value, self._basic_types):
                raise TypeError(
                    f'cannot compare a field of type {type(value).__name__}: take bool, int, '
                    'float or str, as of lambda msg: msg.pose.position.x'
                )
        return bool(val_a != val_b)


class ComparisonFilter(SimpleFilter):
    """Lets out the messages that a handler lets pass."""

    def __init__(
        self,
        comparison_handler: CachedComparisonHandler,
        message_filter: Any = None,
    ) -> None:
        """Connect to a filter.

        :param message_filter: whose messages it takes; None: only those of `add`.
        """
        super().__init__()
        self._comparison_handler = comparison_handler
        self.incoming_connection: int | None = None
        self.connectInput(message_filter)

    def add(self, message: Any) -> None:
        """Let out a message if it fits."""
        if self.message_fits(message):
            self.signalMessage(message)

    def message_fits(self, message: Any) -> bool:
        return self._comparison_handler.message_fits(message)

    def connectInput(self, message_filter: Any) -> None:
        """Take the messages of a filter.

        :raises RuntimeError: it takes those of another already.
        """
        if self.incoming_connection is not None:
            raise RuntimeError(f'Already connected: a {type(self).__name__} has one input')
        if message_filter is not None:
            self.incoming_connection = connect(message_filter, self.add)


class DeltaFilter(ComparisonFilter):
    """Lets out messages in which any of some fields is not as in the last that it let out."""

    def __init__(
        self,
        field_getters: Sequence[FieldGetter],
        message_filter: Any = None,
    ) -> None:
        """Take functions that return a field of a message, as `lambda msg: msg.data`."""
        super().__init__(DeltaCompare(field_getters), message_filter)


class PathDeltaFilter(DeltaFilter):
    """Is a `DeltaFilter` that is given the names of fields, as 'pose.position.x'."""

    def __init__(self, field_path_list: Sequence[str], message_filter: Any = None) -> None:
        super().__init__(
            [partial(self.get_field_by_path, field_path=path) for path in field_path_list],
            message_filter,
        )

    def get_field_by_path(self, message: Any, field_path: str) -> Any:
        """Return a field.

        :raises RuntimeError: the message has none of this name.
        """
        value = message
        for name in field_path.split('.'):
            owner, value = value, getattr(value, name, None)
            if value is None:
                raise RuntimeError(
                    f'field_path={field_path!r}: {type(owner).__name__} has no field {name!r}; '
                    'use names with dots between, from the message on'
                )
        return value
