# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the tests of a module, and hand them what they ask for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
import functools
import inspect
from types import ModuleType
from typing import Any
import unittest
import warnings

from launch import LaunchDescription

from .actions.ready import find_ready_to_test

_READY_TIMEOUT_SEC = 15.0
_Description = Callable[..., tuple[LaunchDescription, dict[str, Any]]]


class TestRun:
    """One launch, the tests that run beside it and those that run when it has ended.

    :param test_description_function: returns the launch description, or a tuple of it and of the
        arguments that tests may ask for.
    :param param_args: the arguments of this function, which tests may ask for too.
    """

    __test__ = False  # pytest takes it for a class of tests by its name

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: Mapping[str, Any],
        pre_shutdown_tests: Iterable[Any],
        post_shutdown_tests: Iterable[Any],
    ) -> None:
        self.name = name
        self._test_description_function = test_description_function
        self.normalized_test_description = _normalize_description(test_description_function)
        self.param_args = dict(param_args)
        self.pre_shutdown_tests = pre_shutdown_tests
        self.post_shutdown_tests = post_shutdown_tests
        # Seconds that the launch may take until ReadyToTest.
        self.timeout: float = getattr(
            test_description_function, '__ready_to_test_action_timeout__', _READY_TIMEOUT_SEC
        )
        if self.param_args:
            for case in self.all_cases():
                test = getattr(case, case._testMethodName)
                case._testMethodName += self._format_params()
                setattr(case, case._testMethodName, test)

    @property
    def markers(self) -> dict[str, Any]:
        return getattr(self._test_description_function, '__markers__', {})

    def bind(
        self,
        tests: Iterable[Any],
        injected_attributes: Mapping[str, Any] | None = None,
        injected_args: Mapping[str, Any] | None = None,
    ) -> None:
        """Let tests have objects, as attributes and as arguments of the same name."""
        cases = list(_cases(tests))
        for test_class in {type(case): None for case in cases}:
            for name, value in (injected_attributes or {}).items():
                setattr(test_class, name, _warning_property(name, value))
            for name in ('setUpClass', 'tearDownClass'):
                _bind_arguments(test_class, name, injected_args or {})
        for case in cases:
            for name in ('setUp', 'tearDown', case._testMethodName):
                _bind_arguments(case, name, injected_args or {})

    def get_launch_description(self) -> LaunchDescription:
        """Return the launch description, to be looked at and not to be launched."""
        return self.normalized_test_description(ready_fn=lambda: None)[0]

    def all_cases(self) -> Iterator[Any]:
        yield from _cases(self.pre_shutdown_tests)
        yield from _cases(self.post_shutdown_tests)

    def __str__(self) -> str:
        return self.name + self._format_params()

    def _format_params(self) -> str:
        return f'[{", ".join(map(str, self.param_args.values()))}]' if self.param_args else ''


class DescriptionError(ValueError):
    """What generate_test_description returns cannot be launched and tested."""


def _normalize_description(function: Callable[..., Any]) -> _Description:
    """Return a function that returns a description and a context.

    The ReadyToTest of the description calls ready_fn.

    :raises DescriptionError: when called: there is no description, or it has no ReadyToTest.
    """

    def describe(
        *, ready_fn: Callable[[], object], **kwargs: Any
    ) -> tuple[LaunchDescription, dict[str, Any]]:
        result = function(**kwargs)
        description, context = result if isinstance(result, tuple) else (result, {})
        if not isinstance(description, LaunchDescription):
            hint = '; is a `return` missing?' if description is None else ''
            raise DescriptionError(
                f'generate_test_description has returned {description!r}: a LaunchDescription '
                f'with a ReadyToTest action is expected, alone or before a dictionary{hint}'
            )
        ready = next(find_ready_to_test(description.entities), None)
        if ready is None:
            raise DescriptionError(
                'generate_test_description functions must return a LaunchDescription containing '
                'a ReadyToTest action'
            )
        ready._add_callback(ready_fn)
        return description, context

    return describe


def LoadTestsFromPythonModule(module: ModuleType, *, name: str = 'launch_tests') -> list[TestRun]:
    """Return the runs of a module: one, or one for each value that it is parametrized with."""
    function = module.generate_test_description
    runs = function() if hasattr(function, '__parametrized__') else [(function, {})]
    return [
        TestRun(
            name,
            description,
            arguments,
            PreShutdownTestLoader().loadTestsFromModule(module),
            PostShutdownTestLoader().loadTestsFromModule(module),
        )
        for description, arguments in runs
    ]


def PreShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run beside the launch."""
    return _Loader(post_shutdown=False)


def PostShutdownTestLoader() -> unittest.TestLoader:
    """Return a loader of the tests that run when the launch has ended."""
    return _Loader(post_shutdown=True)


class _Suite(unittest.TestSuite):
    _cleanup = False  # the tests are looked at when they have run


class _Loader(unittest.TestLoader):
    suiteClass = _Suite

    def __init__(self, *, post_shutdown: bool) -> None:
        super().__init__()
        self.__post_shutdown = post_shutdown

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        if getattr(testCaseClass, '__post_shutdown_test__', False) != self.__post_shutdown:
            return self.suiteClass()
        # A class of its own: what a run hands to its tests stays there.
        own = type(
            testCaseClass.__name__, (testCaseClass,), {'__module__': testCaseClass.__module__}
        )
        return super().loadTestsFromTestCase(own)


def _cases(tests: Any) -> Iterator[Any]:
    """Yield the tests of suites and lists of suites."""
    if isinstance(tests, Iterable):
        for test in tests:
            yield from _cases(test)
    else:
        yield tests


def _bind_arguments(owner: Any, name: str, candidates: Mapping[str, Any]) -> None:
    """Replace a method by one that has those of its arguments that are among the candidates."""
    method = getattr(owner, name)
    wanted = inspect.signature(method).parameters
    arguments = {key: value for key, value in candidates.items() if key in wanted}
    bound = functools.partial(method, **arguments)
    # In a class, Python 3.14 takes a partial for a method.
    setattr(owner, name, staticmethod(bound) if isinstance(owner, type) else bound)


def _warning_property(name: str, value: Any) -> property:
    def get(_self: unittest.TestCase) -> Any:
        warnings.warn(
            f'self.{name} will go in a later release: let the method have an argument {name}',
            stacklevel=2,
        )
        return value

    return property(get)
