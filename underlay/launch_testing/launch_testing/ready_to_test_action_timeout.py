# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Say how long a launch may take until it is ready to be tested."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

_Description = TypeVar('_Description', bound=Callable[..., object])


def ready_to_test_action_timeout(timeout: float) -> Callable[[_Description], _Description]:
    """Return a decorator of test descriptions; without it, ReadyToTest has 15 s.

    :param timeout: seconds.
    """

    def decorate(description: _Description) -> _Description:
        description.__ready_to_test_action_timeout__ = timeout  # type: ignore[attr-defined]
        return description

    return decorate
