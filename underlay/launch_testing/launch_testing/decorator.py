# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Mark tests that run after the launch has ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

_Class = TypeVar('_Class', bound=type)


def post_shutdown_test() -> Callable[[_Class], _Class]:
    """Return a decorator of test classes that run once every process has ended."""

    def decorate(test_class: _Class) -> _Class:
        if not isinstance(test_class, type):
            raise TypeError(f'post_shutdown_test decorates classes of tests, not {test_class!r}')
        test_class.__post_shutdown_test__ = True  # type: ignore[attr-defined]
        return test_class

    return decorate
