# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let pytest run launch tests: files whose generate_test_description has the mark launch_test.

Every run of pytest loads this: launch is imported with the first launch test.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
import copy
from pathlib import Path
import sys
from types import ModuleType
from typing import Any

import pytest

import launch_testing

_ENTRYPOINT = 'generate_test_description'


class LaunchTestFailure(Exception):
    """Tests of a launch have failed.

    :param results: the result of each run.
    """

    def __init__(self, message: str, results: dict[Any, Any]) -> None:
        super().__init__(message)
        self.results = results


class LaunchTestItem(pytest.Item):
    """All launches and tests of one file."""

    test_runs: list[Any]
    runner_cls: Callable[..., Any]

    @classmethod
    def from_parent(  # type: ignore[override]
        cls,
        parent: pytest.Collector,
        *,
        name: str,
        test_runs: Iterable[Any],
        runner_cls: Callable[..., Any] | None = None,
    ) -> LaunchTestItem:
        from ..test_runner import LaunchTestRunner

        item: LaunchTestItem = super().from_parent(parent, name=name)
        item.test_runs = list(test_runs)
        item.runner_cls = runner_cls or LaunchTestRunner
        return item

    def runtest(self) -> None:
        arguments = self.config.getoption('--launch-args')
        runner = self.runner_cls(
            # A run changes its tests, and there may be another one of this item.
            test_runs=copy.deepcopy(self.test_runs),
            launch_file_arguments=[word for words in arguments for word in words],
            debug=self.config.get_verbosity() > 0,
        )
        runner.validate()
        results = runner.run()
        if not all(result.wasSuccessful() for result in results.values()):
            raise LaunchTestFailure('some test cases have failed', results)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        from ..loader import DescriptionError

        if isinstance(excinfo.value, DescriptionError):
            return str(excinfo.value)  # no line of the file is to blame, least of all one of ours
        if not isinstance(excinfo.value, LaunchTestFailure):
            return super().repr_failure(excinfo, style)
        from unittest import TestCase

        failed = [
            f'FAIL: {case.id()}\n{"-" * 70}\n{text}'
            for result in excinfo.value.results.values()
            for case, text in [*result.errors, *result.failures]
            if isinstance(case, TestCase)
        ]
        # None has failed where the launch of a file without tests has.
        return '\n\n'.join(failed) or str(excinfo.value)

    def reportinfo(self) -> tuple[Path, int, str]:
        return self.path, 0, f'launch tests: {self.name}'


class LaunchTestModule(pytest.File):
    """A file of launch tests."""

    @classmethod
    def from_parent(cls, parent: pytest.Collector, **kwargs: Any) -> Any:  # type: ignore[override]
        # Plugins for older versions of pytest call the path so.
        if 'fspath' in kwargs:
            kwargs['path'] = Path(kwargs.pop('fspath'))
        return super().from_parent(parent, **kwargs)

    def makeitem(self, *args: Any, **kwargs: Any) -> LaunchTestItem:
        """Return the item of the file; for subclasses."""
        return LaunchTestItem.from_parent(*args, **kwargs)

    def collect(self) -> Iterator[LaunchTestItem]:
        from ..loader import LoadTestsFromPythonModule

        assert isinstance(self.parent, pytest.Collector)
        module = _import(self.path, self.parent)
        name = module.__name__
        yield self.makeitem(
            name=name, parent=self, test_runs=LoadTestsFromPythonModule(module, name=name)
        )


def _import(path: Path, parent: pytest.Collector) -> ModuleType:
    """Import a file in the way that pytest is set to."""
    module = pytest.Module.from_parent(parent, path=path).obj
    assert isinstance(module, ModuleType)
    return module


def find_launch_test_entrypoint(path: Path, parent: pytest.Collector) -> Callable[..., Any] | None:
    """Return generate_test_description of a file; None where there is none."""
    try:
        if _ENTRYPOINT.encode() not in path.read_bytes():
            return None
        return getattr(_import(path, parent), _ENTRYPOINT, None)
    except (Exception, pytest.skip.Exception):
        # pytest will come upon it again, and say so.
        return None


def pytest_pycollect_makemodule(
    module_path: Path, parent: pytest.Collector
) -> pytest.Collector | None:
    entrypoint = find_launch_test_entrypoint(module_path, parent)
    if entrypoint is None:
        return None
    hook = parent.session.gethookproxy(module_path)
    collector: pytest.Collector | None = hook.pytest_launch_collect_makemodule(
        path=module_path, parent=parent, entrypoint=entrypoint
    )
    return collector


@pytest.hookimpl(trylast=True)
def pytest_launch_collect_makemodule(
    path: Path, parent: pytest.Collector, entrypoint: Callable[..., Any]
) -> pytest.Collector | None:
    if not any(mark.name == 'launch_test' for mark in getattr(entrypoint, 'pytestmark', [])):
        return None
    return with_marks_of(entrypoint, LaunchTestModule.from_parent(parent, path=path))


def with_marks_of(entrypoint: Callable[..., Any], module: LaunchTestModule) -> LaunchTestModule:
    """Return a file with the marks of its test description."""
    for mark in getattr(entrypoint, 'pytestmark', []):
        module.add_marker(getattr(pytest.mark, mark.name).with_args(*mark.args, **mark.kwargs))
    return module


def pytest_addhooks(pluginmanager: pytest.PytestPluginManager) -> None:
    from . import hookspecs

    pluginmanager.add_hookspecs(hookspecs)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        '--launch-args',
        action='append',
        nargs='*',
        default=[],
        help="Launch arguments of launch tests, '<name>:=<value>'.",
    )


def pytest_configure(config: pytest.Config) -> None:
    forget_removed_modules(launch_testing)
    config.addinivalue_line(
        'markers', 'launch_test: the function generate_test_description of a file of launch tests'
    )


def forget_removed_modules(package: ModuleType) -> None:
    """Take from a package its modules that sys.modules has no more, to be imported again.

    A run of pytest within this one, by its plugin pytester, removes at its end what it has
    imported: launch too, of which the modules that are left would know another copy.
    """
    for name, value in list(vars(package).items()):
        is_own = getattr(value, '__name__', '') == f'{package.__name__}.{name}'
        if is_own and value.__name__ not in sys.modules:
            delattr(package, name)
