# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tests that are processes of a launch, as they were written before launch_test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from launch import Action, LaunchContext, LaunchDescription, LaunchService
from launch.actions import EmitEvent, ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnShutdown
from launch.events import ExecutionComplete, Shutdown
from launch.events.process import ProcessExited, ProcessIO

from . import output

__all__ = ['LaunchTestService', 'output']

_Action = TypeVar('_Action', bound=Action)


class LaunchTestService:
    """Runs a launch until its tests are done, and tells by the return code how they went."""

    def __init__(self) -> None:
        # Each test is armed, finished, dropped, failed or succeeded.
        self.__tests: dict[str, str] = {}
        self.__return_codes: dict[str, int] = {}

    def _arm(self, test_name: str) -> None:
        if test_name in self.__tests:
            raise AssertionError(f'{test_name} is a test already')
        self.__tests[test_name] = 'armed'

    def _finish(self, test_name: str) -> list[Action]:
        """End a test that has not told how it went; that is seen at the end of the launch."""
        return self.__end(test_name, 'finished')

    def _drop(self, test_name: str) -> None:
        self.__tests[test_name] = 'dropped'

    def _succeed(self, test_name: str, side_effect: str | None = None) -> list[Action]:
        actions = self.__end(test_name, 'succeeded')
        if not actions and side_effect == 'shutdown':
            return [EmitEvent(event=Shutdown(reason='shutdown after test'))]
        return actions

    def _fail(self, test_name: str, reason: str) -> list[Action]:
        for name, status in self.__tests.items():
            if status == 'armed':
                self.__tests[name] = 'dropped'
        self.__tests[test_name] = 'failed'
        return [EmitEvent(event=Shutdown(reason=reason))]

    def __end(self, test_name: str, status: str) -> list[Action]:
        """Return what ends the launch, where no test is under way any more."""
        self.__tests[test_name] = status
        if 'armed' in self.__tests.values():
            return []
        return [EmitEvent(event=Shutdown(reason='all tests finished'))]

    def add_fixture_action(
        self,
        launch_description: LaunchDescription,
        action: _Action,
        exit_allowed: Sequence[int] | bool = (0,),
    ) -> _Action:
        """Add what tests need; where a process ends that must not, it ends the launch.

        :param exit_allowed: return codes that it may end with, or whether it may end at all.
        """
        launch_description.add_action(action)

        def on_exit(event: ProcessExited, context: LaunchContext) -> Action | None:
            if isinstance(exit_allowed, bool):
                is_allowed = exit_allowed
            else:
                is_allowed = event.returncode in exit_allowed
            if context.is_shutdown or is_allowed:
                return None
            self.__return_codes[event.process_name] = event.returncode or 1
            return EmitEvent(event=Shutdown(reason=f'{event.process_name} fixture process died!'))

        if isinstance(action, ExecuteProcess):
            launch_description.add_action(
                RegisterEventHandler(OnProcessExit(target_action=action, on_exit=on_exit))
            )
        return action

    def add_test_action(self, launch_description: LaunchDescription, action: _Action) -> _Action:
        """Add a test: a process that shall return 0, or any other action that shall complete."""
        test_name = f'test_{id(action)}'

        def on_exit(event: ProcessExited, _context: LaunchContext) -> list[Action]:
            if event.returncode == 0:
                return self._succeed(test_name)
            self.__return_codes[event.process_name] = event.returncode
            return self._fail(test_name, f'{event.process_name} test failed!')

        def on_completion(
            event: ExecutionComplete, _context: LaunchContext
        ) -> list[Action] | None:
            future = event.action.get_asyncio_future()
            if future is not None and future.cancelled():
                self._drop(test_name)
                return None
            if future is not None and future.exception() is not None:
                return self._fail(test_name, str(future.exception()))
            return self._succeed(test_name)

        handler: Any
        if isinstance(action, ExecuteProcess):
            handler = OnProcessExit(target_action=action, on_exit=on_exit)
        else:
            handler = OnExecutionComplete(target_action=action, on_completion=on_completion)
        launch_description.add_action(RegisterEventHandler(handler))
        launch_description.add_action(action)
        self._arm(test_name)
        return action

    def add_output_test(
        self,
        launch_description: LaunchDescription,
        action: ExecuteProcess,
        output_test: Any,
        test_suffix: str = 'output',
        output_filter: Callable[[bytes], bytes] | None = None,
        side_effect: str | None = None,
    ) -> ExecuteProcess:
        """Add a test of what a process of the launch writes to its standard output.

        :param output_test: what a function of the module output returns.
        :param test_suffix: tells several tests of a process apart.
        :param side_effect: 'shutdown' to end the launch where the test has succeeded.
        """
        test_name = f'test_{id(action)}_{test_suffix}'
        text, collate, match, expected = output_test
        missing = list(expected)
        if not missing:
            raise AssertionError(f'{output_test!r}: nothing is expected')

        def on_stdout(event: ProcessIO) -> list[Action] | None:
            nonlocal text, missing
            text = collate(text, output_filter(event.text) if output_filter else event.text)
            missing = [each for each in missing if not match(text, each)]
            return None if missing else self._succeed(test_name, side_effect)

        def on_exit(_event: ProcessExited, _context: LaunchContext) -> list[Action] | None:
            # Its last output may still come.
            return self._finish(test_name) if missing else None

        def on_shutdown(_event: Shutdown, _context: LaunchContext) -> None:
            if missing:
                self._fail(test_name, f'not all output of {action.name} matched!')
            else:
                self._succeed(test_name)

        handlers: list[Any] = [
            OnProcessExit(target_action=action, on_exit=on_exit),
            OnShutdown(on_shutdown=on_shutdown),
            OnProcessIO(target_action=action, on_stdout=on_stdout),
        ]
        for handler in handlers:
            launch_description.add_action(RegisterEventHandler(handler))
        self._arm(test_name)
        return action

    def run(self, launch_service: LaunchService, *args: Any, **kwargs: Any) -> int:
        """Run the launch; return 0, or a return code that is not: the launch's, or a process's."""
        codes = [launch_service.run(*args, **kwargs), *self.__return_codes.values()]
        return next((code for code in codes if code), int('failed' in self.__tests.values()))
