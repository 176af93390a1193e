# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Lets pytest skip tests of linters that have no wheel, as those of `ros2 pkg create` here skip.

Packages that were made with a full ROS 2 import these linters at the top of a test. pytest would
end there, and run none of the package's other tests.
"""

from __future__ import annotations

from collections.abc import Generator
import re

import pytest

_MISSING = re.compile(r"No module named '(ament_(?:copyright|flake8|mypy|pep257|xmllint))")


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    missing = _MISSING.search(str(report.longrepr)) if report.failed else None
    if missing:
        report.outcome = 'skipped'
        reason = f'{missing[1]} is part of a full ROS 2, and has no wheel'
        report.longrepr = (str(collector.path), 1, f'Skipped: {reason}')
    return report
