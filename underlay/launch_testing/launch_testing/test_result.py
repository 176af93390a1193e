# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How the tests of a run have ended."""

from __future__ import annotations

from collections.abc import Iterable
import time
from typing import Any, TYPE_CHECKING
import unittest

if TYPE_CHECKING:
    from .loader import TestRun


class FailResult(unittest.TestResult):
    """Every test of a run has failed, for the launch ended before they did."""

    def __init__(self, test_run: TestRun, message: str) -> None:
        super().__init__()
        for case in test_run.all_cases():
            self.failures.append((case, message))
            self.testsRun += 1

    @property
    def testCases(self) -> list[unittest.TestCase]:
        return [case for case, _ in self.failures]

    @property
    def testTimes(self) -> dict[unittest.TestCase, float]:
        """The seconds that each test took."""
        return dict.fromkeys(self.testCases, 0)

    def wasSuccessful(self) -> bool:
        # Also without any test.
        return False


class SkipResult(unittest.TestResult):
    """Every test of a run was skipped with its description."""

    def __init__(self, test_run: TestRun, skip_reason: str = '') -> None:
        super().__init__()
        for case in test_run.all_cases():
            self.addSkip(case, skip_reason)
            self.testsRun += 1

    @property
    def testCases(self) -> list[unittest.TestCase]:
        return [case for case, _ in self.skipped]

    @property
    def testTimes(self) -> dict[unittest.TestCase, float]:
        """The seconds that each test took."""
        return dict.fromkeys(self.testCases, 0)


class TestResult(unittest.TextTestResult):
    """Records which tests ran and how long each took."""

    __test__ = False  # pytest takes it for a class of tests by its name

    def __init__(
        self, stream: Any = None, descriptions: Any = None, verbosity: Any = None
    ) -> None:
        self.__seconds: dict[unittest.TestCase, float] = {}
        self.__started_sec = 0.0
        super().__init__(stream, descriptions, verbosity)

    @property
    def testCases(self) -> Iterable[unittest.TestCase]:
        return self.__seconds.keys()

    @property
    def testTimes(self) -> dict[unittest.TestCase, float]:
        """The seconds that each test took."""
        return dict(self.__seconds)

    def startTest(self, test: unittest.TestCase) -> None:
        self.__seconds[test] = 0.0
        self.__started_sec = time.monotonic()
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:
        self.__seconds[test] = time.monotonic() - self.__started_sec
        super().stopTest(test)

    def append(self, results: TestResult) -> None:
        """Add the tests of another result."""
        self.__seconds.update(results.__seconds)
        self.testsRun += results.testsRun
        self.failures += results.failures
        self.errors += results.errors
        self.skipped += results.skipped
        self.expectedFailures += results.expectedFailures
        self.unexpectedSuccesses += results.unexpectedSuccesses
