# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The launch is to end."""

from ..event import Event


class Shutdown(Event):
    """Emitted to end the launch.

    :param due_to_sigint: Ctrl-C at the terminal, which the children have got as well.
    """

    name = 'launch.events.Shutdown'

    def __init__(self, *, reason: str = 'reason not given', due_to_sigint: bool = False) -> None:
        self.reason = reason
        self.due_to_sigint = due_to_sigint


class Interrupted(Shutdown):
    """Emitted where this process itself has got SIGINT."""

    def __init__(self) -> None:
        super().__init__(reason='ctrl-c (SIGINT)', due_to_sigint=True)
