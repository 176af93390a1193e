# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""In which thread what is clicked is heard of, and in which order."""

from collections.abc import Callable, Coroutine
from typing import Any


def in_order(hear: Callable[[Any], object]) -> Callable[[Any], Coroutine[Any, Any, None]]:
    """
    Return a callback for viser that hears of each event at once, and of one after the other.

    viser calls a coroutine in the thread of its server; anything else in a pool of threads, some
    time later. There a second click may overtake the first one, and the first is taken for the
    second, for an event has no value of its own: it tells which control has one.

    :param hear: called with the event; it may not wait for anything.
    """

    async def call(event: Any) -> None:
        hear(event)

    return call
