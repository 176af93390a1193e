# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What filters have in common: callbacks for all that comes out of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Callback = Callable[..., object]


class SimpleFilter:
    """Calls callbacks with what it is told to let out; a base class of filters."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callback, tuple[Any, ...]]] = {}

    def registerCallback(self, callback: Callback, *args: Any) -> int:
        """Call `callback` with each output, followed by `args`.

        :returns: a number, for `unregisterCallback`.
        :raises TypeError: it cannot be called.
        """
        if not callable(callback):
            raise TypeError(
                f'callback={callback!r} cannot be called; hand over the function itself, '
                'without brackets'
            )
        # Upstream takes the number of callbacks, which after one is gone may be that of another.
        number = max(self.callbacks, default=-1) + 1
        self.callbacks[number] = (callback, args)
        return number

    def unregisterCallback(self, conn: int) -> None:
        """Call a callback no more; nothing happens where the number is not known."""
        self.callbacks.pop(conn, None)

    def signalMessage(self, *msg: Any) -> None:
        """Call the callbacks, in the order in which they were registered."""
        for callback, args in tuple(self.callbacks.values()):  # a callback may register another
            callback(*msg, *args)


def connect(source: Any, callback: Callback, *args: Any) -> Any:
    """Register a callback with a filter, and return what that returns.

    :raises AttributeError: `source` is none.
    """
    if not hasattr(source, 'registerCallback'):
        raise AttributeError(
            f'{source!r} has no registerCallback: it is no filter; for a topic that is '
            'message_filters.Subscriber(node, msg_type, topic, qos_profile)'
        )
    return source.registerCallback(callback, *args)
