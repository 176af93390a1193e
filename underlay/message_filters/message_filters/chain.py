# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Filters one after another, as one filter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from message_filters.simple_filter import connect, SimpleFilter


class Chain(SimpleFilter):
    """Hands messages to the first of its filters, and lets out what comes out of the last."""

    @dataclass
    class FilterInfo:
        """A filter, and the number of the callback that takes what comes out of it."""

        message_filter: Any
        connection_callback_index: int

    def __init__(self, message_filter: Any = None) -> None:
        """Make a chain without filters.

        :param message_filter: whose messages it takes; None: only those of `add`.
        """
        super().__init__()
        self.incoming_connection: int | None = None
        self._message_filters: dict[int, Chain.FilterInfo] = {}
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: Any) -> None:
        """Take the messages of a filter.

        :raises RuntimeError: it takes those of another already.
        """
        if self.incoming_connection is not None:
            raise RuntimeError('Already connected: a chain has one input')
        self.incoming_connection = connect(message_filter, self.add)

    def add(self, message: Any) -> None:
        """Hand a message to the first filter; without one, let it out."""
        if self._message_filters:
            self._message_filters[0].message_filter.add(message)
        else:
            self.signalMessage(message)

    def addFilter(self, message_filter: Any) -> None:
        """Put a filter at the end, which takes messages with its method `add`."""
        index = len(self._message_filters)
        number = connect(message_filter, self.signalMessage)
        self._message_filters[index] = Chain.FilterInfo(message_filter, number)
        if index:
            before = self._message_filters[index - 1]
            before.message_filter.callbacks.pop(before.connection_callback_index)
            before.connection_callback_index = connect(before.message_filter, message_filter.add)

    def getFilter(self, index: int) -> Any:
        """Return a filter by its place, of which the first is 0.

        :raises KeyError: there is none.
        """
        if index not in self._message_filters:
            raise KeyError(f'index={index!r}: the chain has {len(self._message_filters)} filters')
        return self._message_filters[index].message_filter
