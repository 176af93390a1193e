# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Wait until a process says that it is ready."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from launch import LaunchDescriptionEntity
from launch.actions import ExecuteLocal
from launch.event_handlers import OnProcessIO
from launch.events.process import ProcessIO


class StdoutReadyListener(OnProcessIO):
    """Lets actions run when a process has written a text to its standard output.

    :param target_action: the process; None for any.
    """

    def __init__(
        self,
        *,
        target_action: ExecuteLocal | None = None,
        ready_txt: str,
        actions: Iterable[LaunchDescriptionEntity],
    ) -> None:
        self.__ready_txt = ready_txt
        self.__actions = list(actions)
        super().__init__(target_action=target_action, on_stdout=self.__on_stdout)

    def __on_stdout(self, event: ProcessIO) -> Any:
        is_ready = self.__ready_txt in event.text.decode(errors='replace')
        return self.__actions if is_ready else None

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        return super().describe()[0], self.__actions
