# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Run a program that is a test."""

from __future__ import annotations

from typing import Any

from launch import LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from launch.actions import ExecuteProcess, OpaqueFunction, TimerAction
from launch.event_handlers import OnProcessExit


class Test(ExecuteProcess):
    """Runs a test, at most for a time; the other arguments are those of ExecuteProcess.

    :param timeout: seconds until it is ended by SIGINT; None without end.
    :param kill_timeout: seconds between SIGTERM and SIGKILL.
    """

    __test__ = False  # pytest takes it for a class of tests by its name

    def __init__(
        self,
        *,
        timeout: float | SomeSubstitutionsType | None = None,
        kill_timeout: float | SomeSubstitutionsType = 5.0,
        **kwargs: Any,
    ) -> None:
        super().__init__(**{'sigkill_timeout': kill_timeout, **kwargs})
        self.__timeout = timeout

    @property
    def timeout(self) -> float | SomeSubstitutionsType | None:
        return self.__timeout

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        actions = super().execute(context)
        if not self.__timeout:
            return actions
        end = OpaqueFunction(function=self._shutdown_process, kwargs={'send_sigint': True})
        timer = TimerAction(period=self.__timeout, actions=[end])
        context.register_event_handler(
            OnProcessExit(target_action=self, on_exit=lambda _event, _context: timer.cancel())
        )
        return [*(actions or ()), timer]
