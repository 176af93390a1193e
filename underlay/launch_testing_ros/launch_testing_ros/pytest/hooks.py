# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let pytest run launch tests whose generate_test_description has the mark rostest."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch_testing.pytest.hooks import LaunchTestItem, LaunchTestModule, with_marks_of
import pytest


class LaunchROSTestItem(LaunchTestItem):
    """All launches and tests of one file."""


class LaunchROSTestModule(LaunchTestModule):
    """A file of launch tests."""

    def makeitem(self, *args: Any, **kwargs: Any) -> LaunchTestItem:
        from ..test_runner import LaunchTestRunner

        return LaunchROSTestItem.from_parent(*args, **{**kwargs, 'runner_cls': LaunchTestRunner})


# The hook is one of launch_testing's plugin, which may be blocked.
@pytest.hookimpl(optionalhook=True)
def pytest_launch_collect_makemodule(
    path: Path, parent: pytest.Collector, entrypoint: Callable[..., Any]
) -> pytest.Collector | None:
    if not any(mark.name == 'rostest' for mark in getattr(entrypoint, 'pytestmark', [])):
        return None
    return with_marks_of(entrypoint, LaunchROSTestModule.from_parent(parent, path=path))


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line(
        'markers', 'rostest: the function generate_test_description of a file of ROS launch tests'
    )
