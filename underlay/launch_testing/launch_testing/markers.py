# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Mark test descriptions and tests."""

from __future__ import annotations

from collections.abc import Callable
import functools
import inspect
import time
from typing import Any, TypeVar
import unittest

_Description = TypeVar('_Description', bound=Callable[..., object])
_Test = Callable[..., Any]


def keep_alive(test_description: _Description) -> _Description:
    """Let the launch go on when all of its processes have ended."""
    markers = {**getattr(test_description, '__markers__', {}), 'keep_alive': True}
    test_description.__markers__ = markers  # type: ignore[attr-defined]
    return test_description


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[_Test], _Test]:
    """Return a decorator of test methods that fail only when they fail so many times.

    :param delay: seconds between two tries.
    :raises AssertionError: of the last try.
    """
    if times <= 0:
        raise AssertionError(f'times={times}: a test is tried at least once')

    def decorate(test: _Test) -> _Test:
        if next(iter(inspect.signature(test).parameters), None) != 'self':
            raise AssertionError(f'{test!r} is not a method of a test class')

        @functools.wraps(test)
        def retried(self: Any, *args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                problems = _problems(self)
                counts = [len(each) for each in problems]
                try:
                    result = test(self, *args, **kwargs)
                    if not isinstance(self, unittest.TestCase) or self._outcome.success:  # type: ignore[attr-defined]
                        return result
                except AssertionError:
                    pass
                # What a subtest has told already.
                for problem, count in zip(problems, counts, strict=True):
                    del problem[count:]
                if isinstance(self, unittest.TestCase):
                    self._outcome.success = True  # type: ignore[attr-defined]
                if delay is not None:
                    time.sleep(delay)
            return test(self, *args, **kwargs)

        return retried

    return decorate


def _problems(test: Any) -> list[list[Any]]:
    """Return the lists that failing subtests are written into, in any Python since 3.10."""
    outcome = getattr(test, '_outcome', None)
    result = getattr(outcome, 'result', None)
    owners = ((outcome, 'errors'), (result, 'errors'), (result, 'failures'))
    lists = (getattr(owner, name, None) for owner, name in owners)
    return [each for each in lists if isinstance(each, list)]
