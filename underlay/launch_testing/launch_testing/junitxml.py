# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Write results as JUnit's XML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any
import unittest
from xml.etree import ElementTree


def unittestResultsToXml(
    *, name: str = 'launch_test', test_results: Mapping[Any, Any] | None = None
) -> ElementTree.ElementTree:
    """Return a document of the results of several runs, by what the runs are called."""
    results = test_results or {}
    root = ElementTree.Element('testsuites', name=name)
    root.attrib.update(_counts(results.values(), ('tests', 'failures', 'errors')))
    root.extend(unittestResultToXml(str(run), result) for run, result in results.items())
    return ElementTree.ElementTree(root)


def unittestResultToXml(name: str, test_result: Any) -> ElementTree.Element:
    """Return a suite of the tests of one run."""
    suite = ElementTree.Element('testsuite', name=name)
    suite.attrib.update(_counts([test_result], ('tests', 'failures', 'errors', 'skipped')))
    suite.extend(unittestCaseToXml(test_result, case) for case in test_result.testCases)
    return suite


def _counts(results: Iterable[Any], names: Iterable[str]) -> dict[str, str]:
    all_results = list(results)
    counts = {
        'tests': sum(result.testsRun for result in all_results),
        'failures': sum(len(result.failures) for result in all_results),
        'errors': sum(len(result.errors) for result in all_results),
        'skipped': sum(len(result.skipped) for result in all_results),
    }
    seconds = sum(sum(result.testTimes.values()) for result in all_results)
    return {name: str(counts[name]) for name in names} | {'time': str(round(seconds, 3))}


def unittestCaseToXml(test_result: Any, test_case: unittest.TestCase) -> ElementTree.Element:
    """Return an element of one test of a run."""
    # The id of a run with arguments ends with these: module.Class.test[1, 2].
    method, space, arguments = test_case.id().partition(' ')
    class_name, _, method_name = method.rpartition('.')
    case = ElementTree.Element(
        'testcase',
        classname=class_name,
        name=f'{method_name}{space}{arguments}'.strip(),
        time=str(round(test_result.testTimes[test_case], 3)),
    )
    problems = {
        'failure': test_result.failures,
        'error': test_result.errors,
        'skipped': test_result.skipped,
    }
    for tag, pairs in problems.items():
        for of, message in pairs:
            if of == test_case:
                ElementTree.SubElement(case, tag, message=message)
    return case
