# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run launches and the tests that belong to them."""

from __future__ import annotations

from collections.abc import Iterable
import inspect
import threading
from typing import Any
import unittest

from launch import (
    LaunchDescription,
    LaunchDescriptionEntity,
    LaunchDescriptionSource,
    LaunchService,
)
from launch.actions import IncludeLaunchDescription, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from launch.events.process import ProcessExited

from .io_handler import ActiveIoHandler
from .loader import TestRun
from .parse_arguments import parse_launch_arguments
from .proc_info_handler import ActiveProcInfoHandler
from .test_result import FailResult, SkipResult, TestResult


class _LaunchDiedException(Exception):
    """The launch ended before its tests did."""


class _RunnerWorker:
    """Runs one launch in this thread, and the tests that belong beside it in another."""

    def __init__(
        self,
        test_run: TestRun,
        test_run_preamble: Iterable[LaunchDescriptionEntity],
        launch_file_arguments: Iterable[str] = (),
        debug: bool = False,
    ) -> None:
        self._test_run = test_run
        self._preamble = list(test_run_preamble)
        self._launch_arguments = parse_launch_arguments(launch_file_arguments)
        self._launch_service = LaunchService(debug=debug)
        self._proc_info = ActiveProcInfoHandler()
        self._proc_output = ActiveIoHandler()
        self._ready = threading.Event()
        self._results: TestResult | None = None

    def run(self) -> TestResult:
        """Return the results of all tests of the run.

        :raises unittest.SkipTest: the test description says so.
        :raises _LaunchDiedException: the launch ended before the tests that run beside it.
        """
        description, context = self._test_run.normalized_test_description(ready_fn=self._ready.set)
        self._bind_tests({**context, **self._test_run.param_args})
        self._launch_service.include_launch_description(self._describe(description))
        # The launch needs the main thread, for signals come there.
        threading.Thread(target=self._run_test, name='test_runner_thread', daemon=True).start()
        self._launch_service.run(
            shutdown_when_idle=not self._test_run.markers.get('keep_alive', False)
        )
        if self._results is None:
            print('Processes under test stopped before tests completed')
            self._print_failed_processes()
            raise _LaunchDiedException
        self._results.append(_run_tests(self._test_run.post_shutdown_tests))
        return self._results

    def _bind_tests(self, context: dict[str, Any]) -> None:
        beside = {
            'launch_service': self._launch_service,
            'proc_info': self._proc_info,
            'proc_output': self._proc_output,
            'test_args': dict(self._launch_arguments),
        }
        after = {
            'proc_info': self._proc_info._proc_info_handler,
            'proc_output': self._proc_output._io_handler,
            'test_args': dict(self._launch_arguments),
        }
        run = self._test_run
        run.bind(run.pre_shutdown_tests, beside, {**context, **beside})
        run.bind(run.post_shutdown_tests, after, {**context, **after})

    def _describe(self, description: LaunchDescription) -> LaunchDescription:
        """Add to a launch description what records its processes."""
        info, output = self._proc_info, self._proc_output
        return LaunchDescription(
            [
                *self._preamble,
                RegisterEventHandler(
                    OnProcessStart(on_start=lambda event, _context: info.append(event))
                ),
                RegisterEventHandler(
                    OnProcessStart(on_start=lambda event, _: output.track(event.process_name))
                ),
                RegisterEventHandler(
                    OnProcessExit(on_exit=lambda event, _context: info.append(event))
                ),
                RegisterEventHandler(
                    OnProcessIO(on_stdout=output.append, on_stderr=output.append)
                ),
                IncludeLaunchDescription(
                    LaunchDescriptionSource(launch_description=description),
                    launch_arguments=self._launch_arguments,
                ),
            ]
        )

    def _run_test(self) -> None:
        """Run the tests that belong beside the launch, and end it."""
        try:
            if self._ready.wait(self._test_run.timeout):
                self._results = _run_tests(self._test_run.pre_shutdown_tests)
            else:
                print('Timed out waiting for processes to start up')
        finally:
            self._launch_service.shutdown()

    def _print_failed_processes(self) -> None:
        for event in self._proc_info:
            if isinstance(event, ProcessExited) and event.returncode != 0:
                print(f"Process '{event.process_name}' exited with {event.returncode}")
                title = f"##### '{event.process_name}' output #####"
                print(title)
                for written in self._proc_output[event.action]:
                    print(written.text.decode(errors='replace'))
                print('#' * len(title))


def _run_tests(tests: Any) -> TestResult:
    result = unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(tests)
    assert isinstance(result, TestResult)
    return result


class LaunchTestRunner:
    """Runs launches one after the other, each with its tests.

    :param launch_file_arguments: words of the form name:=value, for every launch.
    :param debug: let launch log debug messages.
    """

    def __init__(
        self,
        test_runs: Iterable[TestRun],
        launch_file_arguments: Iterable[str] = (),
        debug: bool = False,
    ) -> None:
        self._test_runs = list(test_runs)
        self._launch_file_arguments = list(launch_file_arguments)
        self._debug = debug

    def generate_preamble(self) -> list[LaunchDescriptionEntity]:
        """Return what each launch begins with; for subclasses."""
        return []

    def run(self) -> dict[TestRun, Any]:
        """Return the result of each run; none of those after a launch that ended too early."""
        results: dict[TestRun, Any] = {}
        for run in self._test_runs:
            if len(self._test_runs) > 1:
                print(f'\nStarting test run {run}')
            try:
                worker = _RunnerWorker(
                    run, self.generate_preamble(), self._launch_file_arguments, self._debug
                )
                results[run] = worker.run()
            except unittest.SkipTest as skipped:
                print(f'{run} is skipped: {skipped}')
                results[run] = SkipResult(run, str(skipped))
            except _LaunchDiedException:
                message = 'Launch stopped before the active tests finished.'
                results[run] = FailResult(run, message)
                # Most likely somebody has pressed Ctrl-C.
                break
        return results

    def validate(self) -> None:
        """Check that each test description takes the arguments that it will get.

        :raises TypeError: it takes others.
        """
        for run in self._test_runs:
            function = inspect.unwrap(run._test_description_function)
            signature = inspect.getfullargspec(function)
            taken = {*signature.args, *signature.kwonlyargs}
            for name in run.param_args:
                if name not in taken:
                    raise TypeError(
                        'Could not find an argument in generate_test_description matching '
                        f"parametrized argument '{name}'"
                    )
            for name in sorted(taken - set(run.param_args)):
                raise TypeError(
                    f"generate_test_description has unexpected extra argument '{name}'"
                )
